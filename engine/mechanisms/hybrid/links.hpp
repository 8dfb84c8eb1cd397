// Hybrid robot: its links as capsules, and which pairs of them must keep clear of each other.
//
//   A = A''A'   B = B''B'   C = C''C'   F = F1F3, the telescopic shaft   P = A'B', the platform's edge
//
// Pairs that share a joint are not tested. The carriage's y shifts all of them: they do not depend on it.
#pragma once

#include <array>
#include <vector>

#include "engine/mechanisms/hybrid/chain.hpp"
#include "engine/model/obstacle.hpp"
#include "engine/model/placed_link.hpp"

namespace pkm::hybrid {

enum Link { kLinkA, kLinkB, kLinkC, kLinkF, kLinkP, kLinks };

template <class S>
using Links = std::array<Capsule<S>, kLinks>;

template <class S>
Links<S> links(const Geometry<S>& g, const Pose<S>& pose, const Joints<S>& j, const Shaft<S>& shaft) {
  const S zero(0.0), &x = pose.x, &z = pose.z;
  const Point3<S> A2 = {j.s[0] - g.b1, zero, zero}, A1 = {x - g.a, zero, z};
  const Point3<S> B2 = {j.s[2] + g.b2, zero, zero}, B1 = {x + g.a, zero, z};
  const Point3<S> C2 = {j.s[3] + g.c, g.d, zero}, C1 = {x, j.k + g.d, j.N1};
  return {{{{A2, A1}, g.radius[kLinkA]},
           {{B2, B1}, g.radius[kLinkB]},
           {{C2, C1}, g.radius[kLinkC]},
           {{shaft.F1, shaft.F3}, g.radius[kLinkF]},
           {{A1, B1}, g.radius[kLinkP]}}};
}

struct LinkPair {
  Link first, second;
};
inline constexpr std::size_t kLinkPairs = 8;
/// In the order of their margins.
inline constexpr std::array<LinkPair, kLinkPairs> kPairs = {{{kLinkA, kLinkB},
                                                             {kLinkA, kLinkC},
                                                             {kLinkB, kLinkC},
                                                             {kLinkA, kLinkF},
                                                             {kLinkB, kLinkF},
                                                             {kLinkC, kLinkF},
                                                             {kLinkC, kLinkP},
                                                             {kLinkF, kLinkP}}};

/// Distance of two links as capsules [m].
template <class S>
S link_distance(const Links<S>& link, const LinkPair& pair) {
  return capsule_distance(link[pair.first], link[pair.second]);
}

inline constexpr std::array<std::size_t, kLinks> kMoving = {kLinkA, kLinkB, kLinkC, kLinkF, kLinkP};
inline constexpr std::array<const char*, kLinks> kLinkNames = {"link A", "link B", "link C", "telescopic shaft",
                                                               "platform"};

/// What is nearest of the links and obstacles, of which there are some.
template <class S>
Nearest<S> nearest_obstacle(const Geometry<S>& g, const Pose<S>& pose, const Joints<S>& j, const Shaft<S>& shaft,
                            const Obstacles& obstacles) {
  Links<S> all = links(g, pose, j, shaft);
  for (Capsule<S>& link : all) {
    link.axis.from[1] += pose.y;
    link.axis.to[1] += pose.y;
  }
  return pkm::nearest_obstacle<S>(all, kMoving, obstacles);
}

/// The robot as it is drawn at a pose: these links, and what carries them and is carried. Empty where the pose does not
/// assemble.
/// @param p  all parameters
std::vector<PlacedLink> placed_links(std::span<const double> p, const Pose<double>& pose, const WorkingMode& mode);

}  // namespace pkm::hybrid
