// 4PPa-2PaR: what keeps a pose feasible, stated once.
//
// The report on a pose, the plain test of a pose and the names of margins come from visit_margins(); sections and cells
// are closed forms of the lengths that the same limits leave (Ranges), and tested against it.
#pragma once

#include <array>

#include "engine/mechanisms/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

/// Order of the margins, the most basic first: of either limb, the stroke, and the limits in their own order.
inline constexpr std::size_t kReachX = 0, kReachZ = 2, kBelowRail = 4, kStroke = 6, kFirstLimit = 7;
inline constexpr std::size_t kMargins = kFirstLimit + kLimits;
inline constexpr std::array<const char*, kMargins> kMarginNames = {
    "reach_x_1", "reach_x_2", "reach_z_1", "reach_z_2", "below_rail_1", "below_rail_2",  "stroke",
    "alpha_min", "beta_min",  "beta_max",  "h_min",     "sin_par_min",  "cos_theta_min", "clearance_min"};

/// How margins of angles are measured: reports have them in radians, tests compare the sides of triangles.
enum class Angles { in_radians, by_sides };

/// An angle in [0, pi/2] of a right triangle [m].
template <class S>
struct Corner {
  S opposite, adjacent, hypotenuse;

  S radians() const { return atan2(opposite, adjacent); }
};
template <class S>
Corner<S> alpha(const Geometry<S>& g, const Limbs<S>& limbs, std::size_t j) {
  return {S(-limbs.z_c[j]), limbs.h[j], g.l_u};
}
/// Of the lower bars, from the nearer vertical: beta_j, or pi - beta_j in the upper branch.
template <class S>
Corner<S> lean(const Geometry<S>& g, const Limbs<S>& limbs, std::size_t j) {
  return {limbs.x[j], limbs.sigma[j], g.l_d};
}
template <class S>
S beta(const Corner<S>& lean, Branch branch) {
  return branch == Branch::lower ? lean.radians() : S(kPi - lean.radians());
}

/// Calls keep(index, margin) until it says no; returns whether it never did. A margin may come in parts, the least of
/// which counts. All but the clearance, which joints do not tell.
template <Angles angles, class S, class Keep>
[[gnu::always_inline]] inline bool visit_margins(const Geometry<S>& g, const Limits<S>& l, const S& x, const S& y,
                                                 const S& z, const SinCosOf<S>& theta, WorkingMode mode,
                                                 const Keep& keep) {
  constexpr bool sides = angles == Angles::by_sides;
  Limbs<S> limbs{};
  for (std::size_t j = 0; j < 2; ++j) {
    if constexpr (sides)
      limbs.x[j] = limb_x(g, x, theta.cos, j);  // most poses fail there, before a root is taken
    else
      place_limb(g, x, y, z, theta, mode[j], j, limbs);
  }
  const auto above = [](const Corner<S>& at, const S& sine) -> S {
    if constexpr (sides)
      return at.opposite - at.hypotenuse * sine;
    else
      return at.radians() - asin(sine);
  };
  const auto below = [](const Corner<S>& at, const S& sine, [[maybe_unused]] const S& cosine) -> S {
    if constexpr (sides)
      return at.hypotenuse * sine - at.opposite;
    else
      return atan2(sine, cosine) - at.radians();
  };
  const auto across = [&](std::size_t j) __attribute__((always_inline)) {
    const Corner<S> down = lean(g, limbs, j);
    return keep(kReachX + j, limbs.x[j]) && keep(kReachX + j, S(g.l_d - limbs.x[j])) &&  // eq 12
           keep(kFirstLimit + kBetaMin, above(down, l.sin_beta_min)) &&                  // eq 17
           keep(kFirstLimit + kBetaMax, below(down, l.sin_beta_max, l.cos_beta_max));    // eq 20
  };
  const auto along = [&](std::size_t j) __attribute__((always_inline)) {
    if constexpr (sides) place_limb(g, x, y, z, theta, mode[j], j, limbs);
    const Corner<S> up = alpha(g, limbs, j);
    return keep(kReachZ + j, S(g.l_u + limbs.z_c[j])) && keep(kReachZ + j, S(g.l_u - limbs.z_c[j])) &&  // eq 12
           keep(kBelowRail + j, S(-limbs.z_c[j])) &&                                                    // eq 12
           keep(kFirstLimit + kAlphaMin, above(up, l.sin_alpha_min)) &&                                 // eq 17
           keep(kFirstLimit + kHMin, S(limbs.h[j] - l.h_min)) &&                                        // eq 19
           keep(kStroke, limbs.q[2 * j]) && keep(kStroke, S(g.L0 - limbs.q[2 * j + 1]));
  };
  const auto parallel = [&]() -> S {  // |sin(beta_1 + beta_2)|, eq 15
    const Corner<S> one = lean(g, limbs, 0), two = lean(g, limbs, 1);
    if constexpr (sides) {
      const S p = one.opposite * two.adjacent, q = two.opposite * one.adjacent;
      return magnitude(mode[0] == mode[1] ? S(p + q) : S(p - q)) - l.sin_par_min * g.l_d * g.l_d;
    } else {
      return magnitude(sincos(S(beta(one, mode[0]) + beta(two, mode[1]))).sin) - l.sin_par_min;
    }
  };
  return keep(kFirstLimit + kCosThetaMin, S(theta.cos - l.cos_theta_min)) && across(0) && across(1) && along(0) &&
         along(1) && keep(kFirstLimit + kSinParMin, parallel());
}

/// What the limits leave of the lower mode's lengths [m].
template <class S>
struct Ranges {
  S x_min, x_max;          ///< of x_j: l_d sin(beta_min), l_d sin(beta_max)
  S z_low, z_high;         ///< of -z_cj, without the stroke: most sqrt(l_u^2 - h_min^2), least l_u sin(alpha_min)
  S stroke_free;           ///< l_u cos(alpha_min): more stroke does not cut
  S chord_min, chord_max;  ///< of 2 l_d sin p, 2p = beta_1 + beta_2, for sin_par_min = sin(phi): 2 l_d sin, cos(phi/2)
};
template <class S>
Ranges<S> ranges(const Geometry<S>& g, const Limits<S>& l) {
  return {.x_min = g.l_d * l.sin_beta_min,
          .x_max = g.l_d * l.sin_beta_max,
          .z_low = root_or_zero(S((g.l_u - l.h_min) * (g.l_u + l.h_min))),
          .z_high = g.l_u * l.sin_alpha_min,
          .stroke_free = g.l_u * l.cos_alpha_min,
          .chord_min = g.l_d * 2.0 * l.sin_half,
          .chord_max = g.l_d * 2.0 * l.cos_half};
}

}  // namespace pkm::four_ppa_two_par
