// Writes the links of a mechanism at a pose as VTK PolyData, for ParaView.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// Contents of a VTK XML file (.vtp) with the triangle meshes of links and obstacles [m]. The cell data `body` and
/// `part` are the indices of a triangle's body and part; the field data `bodies` and `parts` contain their names,
/// `title` the title.
std::string links_vtp(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title);

}  // namespace pkm
