// 4PPa-2PaR: geometry, limits and forward kinematics. Frames and names: README.md.
//
// Source: "Kinematics analysis and optimal design of a 3T1R parallel mechanism", with its equation numbers.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/pose.hpp"
#include "engine/math/scalar.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm::four_ppa_two_par {

template <class S>
using Pose = SchoenfliesPose<S>;

/// Indices of the parameters of a design.
enum ParameterIndex { kA, kB, kLu, kLd, kD, kL0, kRu, kRd, kDu, kDd, kD0, kRp, kRs, kParameters };

/// Indices of the limits on poses in a LimitSpec.
enum LimitIndex { kAlphaMin, kBetaMin, kBetaMax, kHMin, kSinParMin, kCosThetaMin, kClearanceMin, kLimits };

/// Lengths of a design [m], with the names of the paper; kAll lists them in the order of the parameters.
template <class S>
struct Geometry {
  S a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0, R_p, R_s;

  using G = Geometry;
  static constexpr std::array<S G::*, kParameters> kAll = {&G::a,   &G::b,   &G::l_u, &G::l_d, &G::d,   &G::L0, &G::R_u,
                                                           &G::R_d, &G::d_u, &G::d_d, &G::d_0, &G::R_p, &G::R_s};
};

template <class S>
Geometry<S> geometry(std::span<const S> p) {
  Geometry<S> g;
  for (std::size_t i = 0; i < g.kAll.size(); ++i) g.*g.kAll[i] = p[i];
  return g;
}

/// Thresholds of the constraints on poses; angles are given by their sines and cosines.
template <class S>
struct Limits {
  S sin_alpha_min, cos_alpha_min;
  S sin_beta_min, cos_beta_min;
  S sin_beta_max, cos_beta_max;
  S h_min;               ///< minimum of h [m]
  S sin_par_min;         ///< minimum of sin(beta_1 + beta_2), which is sin(phi)
  S sin_half, cos_half;  ///< sine and cosine of phi/2
  S cos_theta_min;
  std::optional<double> clearance_min;  ///< minimum clearance of links [m]; std::nullopt: no limit

  using L = Limits;
  static constexpr std::array<S L::*, 11> kAll = {
      &L::sin_alpha_min, &L::cos_alpha_min, &L::sin_beta_min, &L::cos_beta_min, &L::sin_beta_max, &L::cos_beta_max,
      &L::h_min,         &L::sin_par_min,   &L::sin_half,     &L::cos_half,     &L::cos_theta_min};
};

/// Converts a Geometry or Limits to another scalar type, with zero derivatives.
template <class To, template <class> class Values, class From>
Values<To> constant(const Values<From>& from) {
  Values<To> to{};
  for (std::size_t i = 0; i < to.kAll.size(); ++i) to.*to.kAll[i] = To(value_of(from.*from.kAll[i]));
  return to;
}

/// Computes the thresholds: those that the study gives, and those derived from the sizes of bars and sliders (eqs 17
/// and 19).
template <class S>
Limits<S> limits(const Geometry<S>& g, const LimitSpec& spec) {
  const auto given = [&](int i) { return sincos(S(spec.given[static_cast<std::size_t>(i)].value_or(0))); };
  const auto of_sine = [](const S& sine) {
    return SinCosOf<S>{sine, sqrt_or_zero(S((S(1.0) - sine) * (S(1.0) + sine)))};
  };
  // Derived minima of alpha and beta: equation (17) of the paper.
  const auto alpha = spec.derived[kAlphaMin] ? of_sine(S(2.0 * g.R_u / g.d_u)) : given(kAlphaMin);
  const auto beta_low = spec.derived[kBetaMin] ? of_sine(S(2.0 * g.R_d / g.d_d)) : given(kBetaMin);
  const auto beta_high = spec.given[kBetaMax] ? given(kBetaMax) : SinCosOf<S>{S(1.0), S(0.0)};
  const double sin_phi = spec.given[kSinParMin].value_or(0), cos_phi = std::sqrt((1 - sin_phi) * (1 + sin_phi));
  const double cos_half = std::sqrt(0.5 * (1 + cos_phi));
  return {.sin_alpha_min = alpha.sin,
          .cos_alpha_min = alpha.cos,
          .sin_beta_min = beta_low.sin,
          .cos_beta_min = beta_low.cos,
          .sin_beta_max = beta_high.sin,
          .cos_beta_max = beta_high.cos,
          .h_min = spec.derived[kHMin] ? S(g.d_0 + g.d_u * 0.5) : S(spec.given[kHMin].value_or(0)),  // equation (19)
          .sin_par_min = S(sin_phi),
          .sin_half = S(0.5 * sin_phi / cos_half),
          .cos_half = S(cos_half),
          .cos_theta_min = S(spec.given[kCosThetaMin].value_or(0)),
          .clearance_min = spec.given[kClearanceMin]};
}

/// Finds all assembly modes, at most 16 (eq 12): theta in [-pi/2, pi/2] and pi - theta, each C_j below or above its
/// rail, and both intersections of two circles. Modes with both C_j below the rails come first.
std::vector<AssemblyMode> forward(const Geometry<double>& g, const AxisVector<double>& q);

}  // namespace pkm::four_ppa_two_par
