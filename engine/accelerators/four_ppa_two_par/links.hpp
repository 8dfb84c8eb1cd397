// 4PPa-2PaR: the links as capsules, and the pairs of links that have to keep a clearance. Figure: README.md, Links.
//
// Positions are relative to the platform's y, on which distances do not depend.
#pragma once

#include <array>

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "engine/geometry/obstacle.hpp"
#include "engine/geometry/placed_link.hpp"

namespace pkm::four_ppa_two_par {

/// Positions of the limbs at a pose, relative to the platform's y. They determine the positions of all links.
template <class S>
struct Placement {
  S sin_theta;
  /// Values of the two limbs [m]: x, height `drop` of the point C_j above D_j, z_c and h (README.md).
  std::array<S, 2> x, drop, z_c, h;
};

/// Placement of the limbs in the mode lower,lower. It is meaningless if a limb does not reach the pose.
inline Placement<double> lower_placement(const Geometry<double>& g, double x, double z, double sin_theta,
                                         double cos_theta) {
  const double half = g.a * cos_theta * 0.5;
  Placement<double> p{.sin_theta = sin_theta, .x = {x - half, g.b - x - half}, .drop = {}, .z_c = {}, .h = {}};
  for (std::size_t j = 0; j < 2; ++j) {
    p.drop[j] = sqrt_or_zero((g.l_d - p.x[j]) * (g.l_d + p.x[j]));
    p.z_c[j] = z + g.d + p.drop[j];
    p.h[j] = sqrt_or_zero((g.l_u - p.z_c[j]) * (g.l_u + p.z_c[j]));
  }
  return p;
}

// Groups of links. Each limb has, in the plane of its rail, two sliders, four upper bars and the upper connector's side
// along y; in the plane y = y_j the upper connector's upright side with two lower bars, and the lower connector.
enum LinkGroup { kSliders, kUpperBars, kConnectorSide, kLowerBars, kLowerConnector, kGroupsPerLimb };
inline constexpr int kPlatform = 2 * kGroupsPerLimb;  ///< index of the platform's group, which is the last one
inline constexpr int kGroups = kPlatform + 1;

/// Index of a group of links of limb 0 or 1.
constexpr int group_of(int limb, LinkGroup group) { return limb * kGroupsPerLimb + group; }

/// Range [first, end) of the links of one group in the list of all links.
struct GroupRange {
  std::size_t first, end;
};
inline constexpr std::array<std::size_t, kGroupsPerLimb> kGroupSize = {2, 4, 1, 3, 1};
inline constexpr std::size_t kLinks = 23;

constexpr GroupRange links_of(int group) {
  std::size_t first = 0;
  for (int g = 0; g < group; ++g) first += kGroupSize[static_cast<std::size_t>(g % kGroupsPerLimb)];
  return {first, group == kPlatform ? kLinks : first + kGroupSize[static_cast<std::size_t>(group % kGroupsPerLimb)]};
}

template <class S>
using Links = std::array<Capsule<S>, kLinks>;

template <class S>
Links<S> links(const Geometry<S>& g, const Placement<S>& p) {
  Links<S> all;
  std::size_t n = 0;
  const auto add = [&](const Point3<S>& from, const Point3<S>& to, const S& radius) {
    all[n++] = {{from, to}, radius};
  };
  const S zero(0.0), shift = g.a * p.sin_theta * 0.5, half_u = g.d_u * 0.5;
  const S slider = max(zero, S(g.d_0 + half_u - g.R_s));
  const S connector = max(g.d, g.d_d);  // length of the lower connector below D_j
  std::array<Point3<S>, 2> joint;       // positions of the joints P_1 and P_2
  for (std::size_t j = 0; j < 2; ++j) {
    const S rail = j == 0 ? zero : g.b, y = j == 0 ? S(-shift) : shift;
    const S x_d = j == 0 ? p.x[0] : S(g.b - p.x[1]), z_c = p.z_c[j], z_d = z_c - p.drop[j];
    const std::array<S, 2> slider_y = {y - p.h[j], y + p.h[j]};
    for (const S& at : slider_y) add({rail, at - slider, zero}, {rail, at + slider, zero}, g.R_s);
    for (const S& at : slider_y) {
      add({rail, at - half_u, zero}, {rail, y - half_u, z_c}, g.R_u);
      add({rail, at + half_u, zero}, {rail, y + half_u, z_c}, g.R_u);
    }
    add({rail, y - half_u, z_c}, {rail, y + half_u, z_c}, g.R_u);
    add({rail, y, z_c}, {rail, y, z_c - g.d_d}, g.R_d);
    add({rail, y, z_c}, {x_d, y, z_d}, g.R_d);
    add({rail, y, z_c - g.d_d}, {x_d, y, z_d - g.d_d}, g.R_d);
    add({x_d, y, z_d}, {x_d, y, z_d - connector}, g.R_d);
    joint[j] = {x_d, y, z_d - g.d};
  }
  add(joint[0], joint[1], g.R_p);
  return all;
}

/// Two groups of links between which the clearance is measured. If both are the group of sliders of one limb, it is
/// measured between its two sliders.
struct GroupPair {
  int first, second;
};
inline constexpr std::size_t kGroupPairs = 35;
/// All pairs: first the sliders of each rail, then the platform with groups of both limbs, then groups of different
/// limbs.
inline constexpr std::array<GroupPair, kGroupPairs> kPairs = [] {
  std::array<GroupPair, kGroupPairs> pairs{};
  std::size_t n = 0;
  for (int limb = 0; limb < 2; ++limb) pairs[n++] = {group_of(limb, kSliders), group_of(limb, kSliders)};
  for (int limb = 0; limb < 2; ++limb)
    for (const LinkGroup group : {kSliders, kUpperBars, kConnectorSide, kLowerBars})
      pairs[n++] = {kPlatform, group_of(limb, group)};
  for (int g = 0; g < kGroupsPerLimb; ++g)
    for (int h = 0; h < kGroupsPerLimb; ++h) pairs[n++] = {g, kGroupsPerLimb + h};
  return pairs;
}();

/// Calls visit(i, k) for every pair of links of which i belongs to the first group of a pair and k to the second.
template <class Visit>
void visit_links(const GroupPair& pair, const Visit& visit) {
  const GroupRange a = links_of(pair.first), b = links_of(pair.second);
  for (std::size_t i = a.first; i < a.end; ++i)
    for (std::size_t k = pair.first == pair.second ? i + 1 : b.first; k < b.end; ++k) visit(i, k);
}

}  // namespace pkm::four_ppa_two_par
