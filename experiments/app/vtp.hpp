// The links of a mechanism at a pose, for ParaView and VTK.
#pragma once

#include <string>
#include <vector>

#include "engine/model/placed_link.hpp"

namespace pkm {

/// The surfaces of links and obstacles in m, as PolyData of VTK's XML format. Each triangle has the number of its body
/// and of its part; the names stand in the field data `bodies` and `parts`, beside the `title`.
std::string links_vtp(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title);

}  // namespace pkm
