// A link of a mechanism where a pose puts it, for pictures.
#pragma once

#include <string>
#include <vector>

#include "engine/model/obstacle.hpp"

namespace pkm {

inline constexpr const char* kFramePart = "frame";        ///< of links that no pose moves
inline constexpr const char* kPlatformPart = "platform";  ///< of those that move with the platform
inline constexpr const char* kObstaclePart = "obstacle";  ///< of what is no link

/// One capsule in the world frame.
struct PlacedLink {
  std::string name;  ///< "rod 12"; of several capsules that are one body, the same name
  std::string part;  ///< "limb 1", or one of the above, or another that the mechanism has ("carriage")
  Capsule<double> body;
};

/// Obstacles as they are drawn beside links; of a box its edges.
inline std::vector<PlacedLink> drawn_obstacles(const Obstacles& obstacles) {
  constexpr double kThin = 0.02;  // radius of an edge over the box's least half size
  std::vector<PlacedLink> drawn;
  for (const Obstacle& obstacle : obstacles) {
    const auto* const box = std::get_if<SolidBox>(&obstacle.shape);
    if (!box) {
      drawn.push_back({obstacle.name, kObstaclePart, std::get<Capsule<double>>(obstacle.shape)});
      continue;
    }
    const auto corner = [box](std::size_t bits) {
      Point3<double> at = box->centre;
      for (std::size_t i = 0; i < 3; ++i) at[i] += bits >> i & 1 ? box->half[i] : -box->half[i];
      return at;
    };
    const double radius = kThin * std::ranges::min(box->half);
    for (std::size_t bits = 0; bits < 8; ++bits)
      for (std::size_t i = 0; i < 3; ++i)
        if (const std::size_t next = bits | std::size_t{1} << i; next != bits)
          drawn.push_back({obstacle.name, kObstaclePart, {{corner(bits), corner(next)}, radius}});
  }
  return drawn;
}

}  // namespace pkm
