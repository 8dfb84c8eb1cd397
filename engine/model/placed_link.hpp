// A link of a mechanism where a pose puts it, for pictures.
#pragma once

#include <string>

#include "engine/model/capsule.hpp"

namespace pkm {

inline constexpr const char* kFramePart = "frame";        ///< of links that no pose moves
inline constexpr const char* kPlatformPart = "platform";  ///< of those that move with the platform

/// One capsule in the world frame.
struct PlacedLink {
  std::string name;  ///< "rod 12"; of several capsules that are one body, the same name
  std::string part;  ///< "limb 1", or one of the above, or another that the mechanism has ("carriage")
  Capsule<double> body;
};

}  // namespace pkm
