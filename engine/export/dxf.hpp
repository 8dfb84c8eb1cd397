// Writer for the links of a mechanism at a pose in the DXF format, release 12, for CAD programs.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// Content of a DXF file with the axes of the links [m]: one line per link, or a point if its ends coincide, with one
/// layer per part. Box obstacles are drawn by their edges.
std::string links_dxf(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
