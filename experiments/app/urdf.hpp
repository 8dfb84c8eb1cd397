// The links of a mechanism at a pose as URDF, which robots' simulators read. URDF holds trees only.
#pragma once

#include <string>
#include <vector>

#include "engine/model/placed_link.hpp"

namespace pkm {

/// Links with what is drawn of them, and between those that share a point a joint there. All joints are fixed: what is
/// drawn says where links meet, not how they move. Links that meet once more, which closes a loop, are named in a
/// comment with the place where the loop is cut; so are links that meet no other, which hang on the frame.
/// @param moved  the links at another pose, which leaves in place what the frame holds; empty: what is drawn of the
///               frame alone says so
/// @param name   of the robot
/// @param title  for a comment
std::string links_urdf(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved,
                       const std::string& name, const std::string& title);

}  // namespace pkm
