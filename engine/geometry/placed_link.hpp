// Links of a mechanism placed in the world frame at one pose, as capsules, for drawing.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/obstacle.hpp"

namespace pkm {

inline constexpr const char* kFramePart = "frame";  ///< value of PlacedLink::part for links that do not move
/// Value of PlacedLink::part for links that move with the platform.
inline constexpr const char* kPlatformPart = "platform";
inline constexpr const char* kObstaclePart = "obstacle";  ///< value of PlacedLink::part for obstacles

/// One capsule in the world frame.
struct PlacedLink {
  std::string name;  ///< name of the body, such as "rod 12"; capsules that form one body have the same name
  std::string part;  ///< kFramePart, kPlatformPart, "limb 1", or a name defined by the mechanism ("carriage")
  Capsule<double> body;
};

/// Converts obstacles to capsules, to draw them like links: a capsule is unchanged, a box becomes its twelve edges.
inline std::vector<PlacedLink> drawn_obstacles(const Obstacles& obstacles) {
  constexpr double kEdgeRadius = 0.02;  // radius of the drawn edges, relative to the smallest half size of the box
  std::vector<PlacedLink> drawn;
  for (const Obstacle& obstacle : obstacles) {
    const auto* const box = std::get_if<SolidBox>(&obstacle.shape);
    if (!box) {
      drawn.push_back({obstacle.name, kObstaclePart, std::get<Capsule<double>>(obstacle.shape)});
      continue;
    }
    const auto vertex = [box](std::size_t bits) {
      Point3<double> at = box->centre;
      for (std::size_t i = 0; i < 3; ++i) at[i] += bits >> i & 1 ? box->half[i] : -box->half[i];
      return at;
    };
    const double radius = kEdgeRadius * std::ranges::min(box->half);
    for (std::size_t bits = 0; bits < 8; ++bits)
      for (std::size_t i = 0; i < 3; ++i)
        if (const std::size_t next = bits | std::size_t{1} << i; next != bits)
          drawn.push_back({obstacle.name, kObstaclePart, {{vertex(bits), vertex(next)}, radius}});
  }
  return drawn;
}

}  // namespace pkm
