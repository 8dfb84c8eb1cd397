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

/// Singularity measures, in [0, 1] (t_beta and sin_lambda signed).
template <class S>
struct Transmission {
  std::array<S, 3> t;  ///< |n_i| / L_i, cosines of the links' pressure angles
  S t_xz, t_beta;      ///< t_beta > 0 on the branch N2 > 0
  S sin_lambda, lambda;
};

template <class S>
Transmission<S> transmission(const Geometry<S>& g, const S& z, const Joints<S>& j) {
  const S width = root_or_zero(S(j.k * j.k + j.N1 * j.N1));  // of limb C across its rail
  return {.t = {magnitude(j.n1) / g.L1, magnitude(j.n2) / g.L2, magnitude(j.n3) / g.L3},
          .t_xz = magnitude(S(z * (j.n1 - j.n2))) / (g.L1 * g.L2),
          .t_beta = j.N2 / (g.e * g.L3),
          .sin_lambda = value_of(width) > 0 ? S(-j.k / width) : S(0.0),
          .lambda = atan2(S(-j.k), j.N1)};
}

/// Calls visit(index, margin) for the margins of a pose, cheap ones first, until it answers false. Reports, pose tests,
/// constraints and derivatives come from this statement alone; the closed forms of section.hpp are compared with it.
/// The margins are finite everywhere.
/// @param branch      required sign of N2, +1 or -1
/// @param with_links  with the links' clearance, else the first kCapsules margins only
/// @return            it has always answered true
template <class S, class Visit>
bool visit_margins(const Geometry<S>& g, const Limits<S>& l, const Pose<S>& pose, const Joints<S>& j, int branch,
                   bool with_links, const Visit& visit) {
  const S &z = pose.z, &beta = pose.angle, one(1.0);
  const auto inside = [](const S& value, const S& lower, const S& upper) {
    return min(S(value - lower), S(upper - value));
  };
  bool goes_on = true;
  const auto add = [&](std::size_t i, const S& margin) { goes_on = goes_on && visit(i, margin); };
  add(kReach1, one - z / g.L1 * (z / g.L1));
  add(kReach2, one - z / g.L2 * (z / g.L2));
  add(kReach3, one - (j.k * j.k + j.N1 * j.N1) / (g.L3 * g.L3));
  for (std::size_t i = 0; i < 4; ++i) add(kStroke1 + i, inside(j.s[i], l.s_min[i], l.s_max[i]));
  add(kZClearance, min(z, j.N1) - l.z_clear);
  add(kBeta, inside(beta, l.beta_min, l.beta_max));
  if (!goes_on) return false;
  const Transmission<S> t = transmission(g, z, j);
  for (std::size_t i = 0; i < 3; ++i) add(kSerial1 + i, t.t[i] - l.tau_s);
  add(kParallelXz, t.t_xz - l.tau_p);
  add(kParallelBeta, t.t_beta * static_cast<double>(branch) - l.tau_p);
  add(kConstraint, t.sin_lambda * home_side(g) - l.tau_c);
  add(kPassiveA, l.psiA.sin - t.t[0]);
  add(kPassiveB, l.psiA.sin - t.t[1]);
  add(kPassiveCIn, l.psiC.sin - t.t[2]);
  add(kPassiveCOut, l.lam_max - magnitude(t.lambda));
  add(kPassiveCpOut, l.mu_max - magnitude(wrapped(S(t.lambda - beta))));
  add(kCarriageGap, g.a * 2.0 + j.n1 - j.n2 - l.gap);
  if (!goes_on) return false;
  const Shaft<S> w = shaft(g, pose);
  add(kAuxBend1, w.cos_phi1 - l.phi.cos);
  add(kAuxBend2, w.cos_phi2 - l.phi.cos);
  add(kAuxLength, inside(w.length, l.lw_min, l.lw_max));
  if (!goes_on || !with_links) return goes_on;
  const Links<S> link = links(g, pose, j, w);
  for (std::size_t i = 0; i < kLinkPairs; ++i) add(kCapsules + i, link_distance(link, kPairs[i]) - l.clearance_min);
  return goes_on;
}

/// All margins of a pose.
template <class S>
Margins<S> margins(const Geometry<S>& g, const Limits<S>& l, const Pose<S>& pose, const Joints<S>& j, int branch) {
  Margins<S> m;
  visit_margins(g, l, pose, j, branch, true, [&](std::size_t i, const S& margin) {
    m[i] = margin;
    return true;
  });
  return m;
}

}  // namespace pkm::hybrid
