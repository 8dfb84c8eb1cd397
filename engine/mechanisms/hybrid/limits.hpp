// Hybrid robot: what bounds its poses, and the margins of one pose.
//
// What bounds them are parameters of the design: strokes, ranges of the joints, what is kept from singularities. A
// study can set tau_s, tau_p and tau_c as limits, too, which then hold instead of the design's own; and a clearance
// of the links other than 0. Measures of singularity: README.md.
#pragma once

#include <optional>
#include <string>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanisms/hybrid/links.hpp"

namespace pkm::hybrid {

/// Order of the pose-level limits that a study may set.
enum LimitIndex { kTauSLimit, kTauPLimit, kTauCLimit, kClearanceMin, kLimits };

/// Thresholds in the form in which the tests use them.
template <class S>
struct Limits {
  std::array<S, 4> s_min, s_max;  ///< [m]
  S z_clear, beta_min, beta_max;  ///< [m], [rad]
  S tau_s, tau_p, tau_c;
  SinCosOf<S> psiA, psiC, lam, mu, phi;  ///< of the greatest angles
  S lam_max, mu_max;                     ///< [rad]
  S gap, lw_min, lw_max;                 ///< [m]
  double clearance_min;                  ///< of the links as capsules [m]
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
          .lam_max = p[kLamMax],
          .mu_max = p[kMuMax],
          .gap = p[kGap],
          .lw_min = p[kLwMin],
          .lw_max = p[kLwMax],
          .clearance_min = spec.given[kClearanceMin].value_or(0)};
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

/// What margins are called, and what they are: lengths [m], or numbers, which are ratios, or angles [rad].
enum class MarginKind { number, length };
struct MarginName {
  const char* name;
  MarginKind kind;
};
inline constexpr std::array<MarginName, kMargins> kMarginNames = [] {
  using enum MarginKind;
  return std::array<MarginName, kMargins>{
      {{"reach1", number},      {"reach2", number},        {"reach3", number},       {"stroke1", length},
       {"stroke2", length},     {"stroke3", length},       {"stroke4", length},      {"zclear", length},
       {"beta", number},        {"serial1", number},       {"serial2", number},      {"serial3", number},
       {"parallel_xz", number}, {"parallel_beta", number}, {"constraint", number},   {"passiveA", number},
       {"passiveB", number},    {"passiveC_in", number},   {"passiveC_out", number}, {"passiveCp_out", number},
       {"gap", length},         {"aux_bend1", number},     {"aux_bend2", number},    {"aux_len", length},
       {"cap_AB", length},      {"cap_AC", length},        {"cap_BC", length},       {"cap_AF", length},
       {"cap_BF", length},      {"cap_CF", length},        {"cap_CP", length},       {"cap_FP", length}}};
}();

template <class S>
using Margins = std::array<S, kMargins>;

/// The sign of sin(lambda) at beta = 0, the side of the constraint singularity on which the robot stays.
template <class S>
double home_side(const Geometry<S>& g) {
  return value_of(g.d) < value_of(g.e) ? -1 : 1;
}

/// p / q, or 0 where q is 0: the sine or cosine of an angle of a triangle.
template <class S>
S share(const S& p, const S& q) {
  return value_of(q) > 0 ? S(p / q) : S(0.0);
}

/// Singularity measures, in [0, 1] (t_beta and sin_lambda signed).
template <class S>
struct Transmission {
  std::array<S, 3> t;    ///< |n| / L, the cosines of the links' pressure angles
  S t_xz;                ///< the sine of the angle of links A and B
  S t_beta;              ///< > 0 on the branch N2 > 0
  S sin_lambda, lambda;  ///< of limb C across its rail
};

template <class S>
Transmission<S> transmission(const Geometry<S>& g, const S& z, const Joints<S>& j) {
  return {.t = {share(magnitude(j.n1), g.L1), share(magnitude(j.n2), g.L2), share(magnitude(j.n3), g.L3)},
          .t_xz = share(magnitude(S(z * (j.n1 - j.n2))), S(g.L1 * g.L2)),
          .t_beta = share(j.N2, S(g.e * g.L3)),
          .sin_lambda = share(S(-j.k), root_or_zero(S(j.k * j.k + j.N1 * j.N1))),
          .lambda = atan2(S(-j.k), j.N1)};
}

/// All margins of a pose, finite everywhere. Reports, constraints and derivatives come from this statement alone; the
/// closed forms of section.hpp are compared with it.
/// @param branch  required sign of N2, +1 or -1
template <class S>
Margins<S> margins(const Geometry<S>& g, const Limits<S>& l, const Pose<S>& pose, const WorkingMode& mode, int branch) {
  const S& z = pose.z;
  const Joints<S> j = inverse(g, pose, mode);
  const Transmission<S> t = transmission(g, z, j);
  const Shaft<S> w = shaft(g, pose);
  const Links<S> link = links(g, pose, j, w);
  const auto inside = [](const S& value, const S& lower, const S& upper) {
    return S(min(S(value - lower), S(upper - value)));
  };
  Margins<S> m;
  m[kReach1] = S(1.0) - z / g.L1 * (z / g.L1);
  m[kReach2] = S(1.0) - z / g.L2 * (z / g.L2);
  m[kReach3] = S(1.0) - (j.k * j.k + j.N1 * j.N1) / (g.L3 * g.L3);
  for (std::size_t i = 0; i < 4; ++i) m[kStroke1 + i] = inside(j.s[i], l.s_min[i], l.s_max[i]);
  m[kZClearance] = min(z, j.N1) - l.z_clear;
  m[kBeta] = inside(pose.angle, l.beta_min, l.beta_max);
  for (std::size_t limb = 0; limb < 3; ++limb) {
    m[kSerial1 + limb] = t.t[limb] - l.tau_s;
    m[kPassiveA + limb] = (limb < 2 ? l.psiA : l.psiC).sin - t.t[limb];
  }
  m[kParallelXz] = t.t_xz - l.tau_p;
  m[kParallelBeta] = t.t_beta * static_cast<double>(branch) - l.tau_p;
  m[kConstraint] = t.sin_lambda * home_side(g) - l.tau_c;
  m[kPassiveCOut] = l.lam_max - magnitude(t.lambda);
  m[kPassiveCpOut] = l.mu_max - magnitude(wrapped(S(t.lambda - pose.angle)));
  m[kCarriageGap] = g.a * 2.0 + j.n1 - j.n2 - l.gap;
  m[kAuxBend1] = w.cos_phi1 - l.phi.cos;
  m[kAuxBend2] = w.cos_phi2 - l.phi.cos;
  m[kAuxLength] = inside(w.length, l.lw_min, l.lw_max);
  for (std::size_t i = 0; i < kLinkPairs; ++i) m[kCapsules + i] = link_distance(link, kPairs[i]) - l.clearance_min;
  return m;
}

}  // namespace pkm::hybrid
