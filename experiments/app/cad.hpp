// The links of a mechanism at a pose, for CAD. Files are in m.
#pragma once

#include <string>
#include <vector>

#include "engine/model/placed_link.hpp"

namespace pkm {

/// The surfaces of links and obstacles as binary STL: tubes with round ends, a ball where a link is a point.
std::string links_stl(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title);

/// The links' axes as DXF of release 12: a line each, a point where a link is one, on a layer for each part; of a box
/// its edges.
std::string links_dxf(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
