// Writes the links of a mechanism at a pose as URDF, the robot description format of ROS. URDF describes trees only, so
// kinematic loops are cut.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// Contents of a URDF file: the links with their capsules as visuals, and a joint wherever two links share a point. All
/// joints are fixed: the file shows where links are connected, but not how they move. The joints of the tree are found
/// by a breadth-first search from the frame. Every other connection closes a loop; a comment lists these connections
/// with the points where the loops are cut. Links without a connection to the frame are attached to it, and listed in a
/// comment.
/// @param moved  the same links at another pose, or empty. An end that has the same position at both poses counts as
/// connected to the frame; if `moved` is empty, only ends that lie on the capsules of the frame do
/// @param name   name of the robot
/// @param title  text of a comment at the beginning of the file
std::string links_urdf(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved,
                       const std::string& name, const std::string& title);

}  // namespace pkm
