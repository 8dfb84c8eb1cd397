// (3CRR/R)&CRU and Quadrupteron: links as capsules, and which pairs of them must keep clear of each other (README.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/mechanisms/crr_cru/model.hpp"
#include "engine/model/obstacle.hpp"
#include "engine/model/placed_link.hpp"

namespace pkm::crr_cru {

/// Radii of the links [m]: the last parameters, whatever masses come before them.
template <class S>
struct LinkRadii {
  S rod, platform, rail;
};
inline constexpr std::size_t kLinkRadii = 3;

/// @param p  all parameters
template <class S>
LinkRadii<S> link_radii(std::span<const S> p) {
  const auto radii = p.last(kLinkRadii);
  return {radii[0], radii[1], radii[2]};
}

// Order of the links: rods 11, 12, 21, .. 42, rails 1 to 4, arms to C_1 .. C_3, post, arm to C_4.
inline constexpr std::size_t kFirstRail = 8, kFirstArm = 12, kPost = 15, kArm4 = 16, kLinks = 17;

template <class S>
using Links = std::array<Capsule<S>, kLinks>;

template <class S>
Links<S> links(const Geometry<S>& g, const LinkRadii<S>& radius, const Limbs<S>& limbs) {
  Links<S> all;
  for (std::size_t i = 0; i < 4; ++i) {
    const Limb<S>& limb = limbs.limb[i];
    all[2 * i] = {{limb.A, limb.B}, radius.rod};
    all[2 * i + 1] = {{limb.B, limb.C}, radius.rod};
    Point3<S> from = limb.A, to = limb.A;
    from[kLimbs[i].e] = g.rho_min;
    to[kLimbs[i].e] = g.rho_max;
    all[kFirstRail + i] = {{from, to}, radius.rail};
  }
  Point3<S> D = limbs.N;
  D[2] += g.h;
  for (std::size_t i = 0; i < 3; ++i) all[kFirstArm + i] = {{limbs.N, limbs.limb[i].C}, radius.platform};
  all[kPost] = {{limbs.N, D}, radius.platform};
  all[kArm4] = {{D, limbs.limb[3].C}, radius.platform};
  return all;
}

inline constexpr std::size_t kLinkPairs = 24 + 36 + 44;
inline constexpr std::array<LinkPair, kLinkPairs> kPairs = [] {
  std::array<LinkPair, kLinkPairs> pairs{};
  std::size_t n = 0;
  for (std::size_t rod = 0; rod < kFirstRail; ++rod) {
    for (std::size_t other = rod + 1; other < kFirstRail; ++other)
      if (rod / 2 != other / 2) pairs[n++] = {rod, other};
    for (std::size_t arm = kFirstArm; arm < kLinks; ++arm) {
      const std::size_t own = rod / 2 == 3 ? kArm4 : kFirstArm + rod / 2;
      if (rod % 2 == 0 || arm != own) pairs[n++] = {rod, arm};
    }
  }
  for (std::size_t rail = kFirstRail; rail < kFirstArm; ++rail) {
    for (std::size_t rod = 0; rod < kFirstRail; ++rod)
      if (rod / 2 != rail - kFirstRail) pairs[n++] = {rod, rail};
    for (std::size_t arm = kFirstArm; arm < kLinks; ++arm) pairs[n++] = {rail, arm};
  }
  return pairs;
}();

/// All but the rails.
inline constexpr std::array<std::size_t, kLinks - 4> kMoving = [] {
  std::array<std::size_t, kLinks - 4> moving{};
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = i < kFirstRail ? i : i + 4;
  return moving;
}();

/// `second` is kLinks and more for obstacles.
template <class S>
Nearest<S> nearest_bodies(const Links<S>& all, const Obstacles& obstacles) {
  const Nearest<S> link = nearest_of(all, [](const auto& visit) {
    for (const LinkPair& pair : kPairs) visit(pair.first, pair.second);
  });
  const Nearest<S> other = nearest_obstacle<S>(all, kMoving, obstacles);
  if (!(value_of(other.clearance) < value_of(link.clearance))) return link;
  return {other.clearance, other.first, kLinks + other.second};
}

/// Whether no pair is nearer than `least` [m], and no link to an obstacle.
inline bool keep_clear(const Links<double>& all, double least, const Obstacles& obstacles) {
  std::array<Bounds<double>, kLinks> box;
  return pkm::keep_clear(all, kPairs, least, box) && keep_clear_of(obstacles, all, kMoving, least);
}

/// "rod 12", "rail 3", "middle platform", "moving platform", "platform".
inline std::string link_name(std::size_t link, Platform platform) {
  if (link < kFirstRail) return "rod " + std::to_string(link / 2 + 1) + std::to_string(link % 2 + 1);
  if (link < kFirstArm) return "rail " + std::to_string(link - kFirstRail + 1);
  if (platform == Platform::rigid) return "platform";
  return link == kArm4 ? "moving platform" : "middle platform";
}

/// All links at a pose, and the slides, drawn as balls that the rails run through. Empty where the pose does not
/// assemble.
inline std::vector<PlacedLink> placed_links(const Geometry<double>& g, const LinkRadii<double>& radius,
                                            const Pose<double>& pose, const WorkingMode& mode) {
  std::vector<PlacedLink> placed;
  const Limbs<double> limbs = inverse(g, pose, mode);
  if (!limbs.assembles) return placed;
  const Links<double> all = links(g, radius, limbs);
  const auto limb_called = [](std::size_t i) { return "limb " + std::to_string(i + 1); };
  for (std::size_t i = 0; i < kLinks; ++i) {
    const std::string part = i < kFirstRail ? limb_called(i / 2) : i < kFirstArm ? kFramePart : kPlatformPart;
    placed.push_back({link_name(i, g.platform), part, all[i]});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Point3<double>& A = limbs.limb[i].A;
    placed.push_back({"slide " + std::to_string(i + 1), limb_called(i), {{A, A}, 2 * radius.rail}});
  }
  return placed;
}

}  // namespace pkm::crr_cru
