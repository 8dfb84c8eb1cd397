// Hybrid robot: limits of its poses.
//
// They are parameters of the design: strokes, ranges of the joints, distances from singularities (README.md). A study
// can replace tau_s, tau_p and tau_c by limits of its own.
#pragma once

#include <optional>
#include <string>

#include "engine/accelerators/hybrid/model.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm::hybrid {

/// Indices of the limits on poses that a study may set.
enum LimitIndex { kTauSLimit, kTauPLimit, kTauCLimit, kClearanceMin, kLimits };

/// Thresholds of the pose-level constraints, named as in README.md: strokes s, minimum height z_clear of O'' and C'
/// above the base, range of beta, distances tau from singularities, maximum joint angles, minimum distance of the
/// carriages A and B, length lw of the shaft.
template <class S>
struct Limits {
  std::array<S, 4> s_min, s_max;  ///< minimum and maximum stroke of each drive [m]
  S z_clear, beta_min, beta_max;  ///< minimum height of O'' and C' above the base [m]; range of beta [rad]
  S tau_s, tau_p, tau_c;
  SinCosOf<S> psiA, psiC, lam, mu, phi;  ///< sine and cosine of the maximum joint angles
  S gap, lw_min, lw_max;  ///< minimum distance of the carriages A and B; range of the length of the shaft [m]
};

template <class S>
Limits<S> limits(std::span<const S> p, const LimitSpec& spec) {
  const auto given = [&](LimitIndex limit, const S& own) { return spec.given[limit] ? S(*spec.given[limit]) : own; };
  const auto four = [&](std::size_t first) {
    return std::array<S, 4>{p[first], p[first + 1], p[first + 2], p[first + 3]};
  };
  return {.s_min = four(kSMin),
          .s_max = four(kSMax),
          .z_clear = p[kZClear],
          .beta_min = p[kBetaMin],
          .beta_max = p[kBetaMax],
          .tau_s = given(kTauSLimit, p[kTauS]),
          .tau_p = given(kTauPLimit, p[kTauP]),
          .tau_c = given(kTauCLimit, p[kTauC]),
          .psiA = sincos(p[kPsiAMax]),
          .psiC = sincos(p[kPsiCMax]),
          .lam = sincos(p[kLamMax]),
          .mu = sincos(p[kMuMax]),
          .phi = sincos(p[kPhiMax]),
          .gap = p[kGap],
          .lw_min = p[kLwMin],
          .lw_max = p[kLwMax]};
}

/// Sign of sin(lambda) at beta = 0. It identifies the side of the constraint singularity on which the robot stays.
template <class S>
double home_side(const Geometry<S>& g) {
  return value_of(g.d) < value_of(g.e) ? -1 : 1;
}

}  // namespace pkm::hybrid
