// Writes the links of a mechanism at a pose as URDF, the robot description format of ROS. URDF describes trees only, so
// kinematic loops are cut.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// Contents of a URDF file: the links with their capsules as visuals, and a joint where two links share a point. All
/// joints are fixed: the capsules show where links are connected, but not how they move. A breadth-first search from
/// the frame selects the joints of the tree. Each further connection, which closes a loop, is listed in a comment with
/// the point where the loop is cut. Links without a connection to the frame are attached to it, and listed in a
/// comment.
/// @param moved  the same links at another pose: ends that do not move are taken as connected to the frame; empty: only
///               ends on the capsules of the frame are
/// @param name   name of the robot
/// @param title  text of a comment
std::string links_urdf(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved,
                       const std::string& name, const std::string& title);

}  // namespace pkm
