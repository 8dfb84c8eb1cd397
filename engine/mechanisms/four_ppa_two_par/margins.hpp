// 4PPa-2PaR: what keeps a pose feasible, stated once.
//
// The report on a pose has its margins from here; sections and cells are closed forms of the lengths that the same
// limits leave (Ranges), and tested against them.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "engine/mechanisms/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

/// Order of the margins, the most basic first: of either limb, the stroke, and the limits in their own order.
inline constexpr std::size_t kReachX = 0, kReachZ = 2, kBelowRail = 4, kStroke = 6, kFirstLimit = 7;
inline constexpr std::size_t kMargins = kFirstLimit + kLimits;
inline constexpr std::array<const char*, kMargins> kMarginNames = {
    "reach_x_1", "reach_x_2", "reach_z_1", "reach_z_2", "below_rail_1", "below_rail_2",  "stroke",
    "alpha_min", "beta_min",  "beta_max",  "h_min",     "sin_par_min",  "cos_theta_min", "clearance_min"};

/// alpha_j [rad]
template <class S>
S alpha(const Limbs<S>& limb, std::size_t j) {
  return atan2(S(-limb.z_c[j]), limb.h[j]);
}
/// Of the lower bars, from the nearer vertical: beta_j, or pi - beta_j in the upper branch [rad].
template <class S>
S lean(const Limbs<S>& limb, std::size_t j) {
  return atan2(limb.x[j], limb.sigma[j]);
}
template <class S>
S beta(const Limbs<S>& limb, std::size_t j, Branch branch) {
  return branch == Branch::lower ? lean(limb, j) : S(kPi - lean(limb, j));
}

/// All but the clearance, which joints do not tell: it is infinite.
template <class S>
std::array<S, kMargins> margins(const Geometry<S>& g, const Limits<S>& l, const Limbs<S>& limb, double cos_theta,
                                WorkingMode mode) {
  std::array<S, kMargins> m;
  for (std::size_t j = 0; j < 2; ++j) {  // eq 12
    m[kReachX + j] = min(limb.x[j], S(g.l_d - limb.x[j]));
    m[kReachZ + j] = min(S(g.l_u + limb.z_c[j]), S(g.l_u - limb.z_c[j]));
    m[kBelowRail + j] = -limb.z_c[j];
  }
  m[kStroke] = min(min(limb.q[0], limb.q[2]), S(g.L0 - max(limb.q[1], limb.q[3])));
  S* const limit = &m[kFirstLimit];
  limit[kAlphaMin] = min(alpha(limb, 0), alpha(limb, 1)) - atan2(l.sin_alpha_min, l.cos_alpha_min);  // eq 17
  limit[kBetaMin] = min(lean(limb, 0), lean(limb, 1)) - atan2(l.sin_beta_min, l.cos_beta_min);       // eq 17
  limit[kBetaMax] = atan2(l.sin_beta_max, l.cos_beta_max) - max(lean(limb, 0), lean(limb, 1));       // eq 20
  limit[kHMin] = min(limb.h[0], limb.h[1]) - l.h_min;                                                // eq 19
  const S sum = beta(limb, 0, mode[0]) + beta(limb, 1, mode[1]);
  limit[kSinParMin] = magnitude(sincos(sum).sin) - l.sin_par_min;  // eq 15
  limit[kCosThetaMin] = cos_theta - l.cos_theta_min;
  limit[kClearanceMin] = S(std::numeric_limits<double>::infinity());
  return m;
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
