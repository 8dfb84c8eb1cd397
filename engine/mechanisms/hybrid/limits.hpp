// Hybrid robot: what bounds its poses, and the margins of one pose.
//
// What bounds them are parameters of the design: strokes, ranges of the joints, what is kept from singularities. A
// study can set tau_s, tau_p and tau_c as limits, too, which then hold instead of the design's own; and a clearance
// of the links other than 0.
//
// With lambda = atan2(d - e cos b, z + e sin b), the inclination of the plane of limb C about X,
//
//   t_xz = |z (n1 - n2)| / (L1 L2)   sine of the angle between links A and B
//   N2 / (e L3)                      cosine of the angle between link C and the velocity of C' in a rotation
//
// Source: hybrid-robot document, sections 6 and 7.
#pragma once

#include <optional>
#include <string>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanisms/hybrid/links.hpp"

namespace pkm::hybrid {

/// Order of the pose-level limits that a study may set.
enum LimitIndex { kTauSLimit, kTauPLimit, kTauCLimit, kClearanceMin, kLimits };

/// Links overlap by the sum of their radii at most, and no radius is greater than 1 m.
inline constexpr double kNoClearance = -2;

/// Thresholds in the form in which the tests use them.
template <class S>
struct Limits {
  std::array<S, 4> s_min, s_max;  ///< [m]
  S z_clear, beta_min, beta_max;  ///< [m], [rad]
  S tau_s, tau_p, tau_c;
  SinCosOf<S> psiA, psiC, phi;  ///< of the greatest angles
  S lam_max, mu_max;            ///< [rad]
  S gap, lw_min, lw_max;        ///< [m]
  double clearance_min;         ///< of the links as capsules [m]
};

template <class S>
Limits<S> limits(std::span<const S> p, const LimitSpec& spec) {
  const auto given = [&](LimitIndex limit, const S& own) { return spec.given[limit] ? S(*spec.given[limit]) : own; };
  const auto four = [&](std::size_t first) {
    return std::array<S, 4>{p[first], p[first + 1], p[first + 2], p[first + 3]};
  };
  return {four(kSMin),
          four(kSMax),
          p[kZClear],
          p[kBetaMin],
          p[kBetaMax],
          given(kTauSLimit, p[kTauS]),
          given(kTauPLimit, p[kTauP]),
          given(kTauCLimit, p[kTauC]),
          sincos(p[kPsiAMax]),
          sincos(p[kPsiCMax]),
          sincos(p[kPhiMax]),
          p[kLamMax],
          p[kMuMax],
          p[kGap],
          p[kLwMin],
          p[kLwMax],
          spec.given[kClearanceMin].value_or(0)};
}

/// Order of the margins; a pose is feasible where z > 0 and all of them are >= 0. Lengths are in m, angles in rad.
enum MarginIndex {
  kReach1,
  kReach2,
  kReach3,  ///< where one of these three is < 0 the others have no meaning
  kStroke1,
  kStroke2,
  kStroke3,
  kStroke4,
  kZClearance,
  kBeta,
  kSerial1,
  kSerial2,
  kSerial3,
  kParallelXz,
  kParallelBeta,
  kConstraint,
  kPassiveA,
  kPassiveB,
  kPassiveCIn,
  kPassiveCOut,
  kPassiveCpOut,
  kCarriageGap,
  kAuxBend1,
  kAuxBend2,
  kAuxLength,
  kCapsules,  ///< one for each of kPairs
  kMargins = kCapsules + kLinkPairs
};

/// "reach1" .. "cap_FP"
const std::array<std::string, kMargins>& margin_names();

template <class S>
using Margins = std::array<S, kMargins>;

/// Singularity measures of section 6, in [0, 1] (t_beta and sin_lambda signed).
template <class S>
struct Transmission {
  std::array<S, 3> t;  ///< |n_i| / L_i, cosines of the links' pressure angles
  S t_xz, t_beta;      ///< t_beta > 0 on the branch N2 > 0
  S sin_lambda, lambda;
};

template <class S>
Transmission<S> transmission(const Geometry<S>& g, const S& z, const Joints<S>& j) {
  const S width = root_or_zero(S(j.k * j.k + j.N1 * j.N1));  // of limb C across its rail
  return {{magnitude(j.n1) / g.L1, magnitude(j.n2) / g.L2, magnitude(j.n3) / g.L3},
          magnitude(S(z * (j.n1 - j.n2))) / (g.L1 * g.L2),
          j.N2 / (g.e * g.L3),
          value_of(width) > 0 ? S(-j.k / width) : S(0.0),
          atan2(S(-j.k), j.N1)};
}

/// The margins of a pose, finite everywhere.
/// @param branch  required sign of N2, +1 or -1
template <class S>
Margins<S> margins(const Geometry<S>& g, const Limits<S>& l, const Pose<S>& pose, const Joints<S>& j, int branch) {
  const S &z = pose.z, &beta = pose.angle, one(1.0);
  const auto inside = [](const S& value, const S& lower, const S& upper) {
    return min(S(value - lower), S(upper - value));
  };
  const Transmission<S> t = transmission(g, z, j);
  const Shaft<S> w = shaft(g, pose);
  const Links<S> link = links(g, pose, j, w);
  const double side = value_of(g.d) < value_of(g.e) ? -1 : 1;  // the one of beta = 0
  Margins<S> m;
  m[kReach1] = one - z / g.L1 * (z / g.L1);
  m[kReach2] = one - z / g.L2 * (z / g.L2);
  m[kReach3] = one - (j.k * j.k + j.N1 * j.N1) / (g.L3 * g.L3);
  for (std::size_t i = 0; i < 4; ++i) m[kStroke1 + i] = inside(j.s[i], l.s_min[i], l.s_max[i]);
  m[kZClearance] = min(z, j.N1) - l.z_clear;
  m[kBeta] = inside(beta, l.beta_min, l.beta_max);
  for (std::size_t i = 0; i < 3; ++i) m[kSerial1 + i] = t.t[i] - l.tau_s;
  m[kParallelXz] = t.t_xz - l.tau_p;
  m[kParallelBeta] = t.t_beta * static_cast<double>(branch) - l.tau_p;
  m[kConstraint] = t.sin_lambda * side - l.tau_c;
  m[kPassiveA] = l.psiA.sin - t.t[0];
  m[kPassiveB] = l.psiA.sin - t.t[1];
  m[kPassiveCIn] = l.psiC.sin - t.t[2];
  m[kPassiveCOut] = l.lam_max - magnitude(t.lambda);
  m[kPassiveCpOut] = l.mu_max - magnitude(wrapped(S(t.lambda - beta)));
  m[kCarriageGap] = g.a * 2.0 + j.n1 - j.n2 - l.gap;
  m[kAuxBend1] = w.cos_phi1 - l.phi.cos;
  m[kAuxBend2] = w.cos_phi2 - l.phi.cos;
  m[kAuxLength] = inside(w.length, l.lw_min, l.lw_max);
  for (std::size_t i = 0; i < kLinkPairs; ++i)
    m[kCapsules + i] = capsule_distance(link[kPairs[i].first], link[kPairs[i].second]) - l.clearance_min;
  return m;
}

/// Whether a pose with these margins is feasible.
template <class S>
bool feasible(const S& z, const Margins<S>& margins) {
  bool all = value_of(z) > 0;
  for (const S& margin : margins) all = all && value_of(margin) >= 0;
  return all;
}

}  // namespace pkm::hybrid
