// Export of a mechanism's links at one pose for CAD programs: surfaces as STL, axes as DXF. Lengths are in m.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// The surfaces of links and obstacles as binary STL: a capsule (a tube with hemispherical ends) for each link, a
/// sphere for a link whose ends coincide.
std::string links_stl(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title);

/// The axes of the links as DXF, release 12: one line per link, or a point if its ends coincide, with one layer per
/// part. Box obstacles are drawn by their edges.
std::string links_dxf(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
