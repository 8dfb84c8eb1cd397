// Hybrid robot: exact volumes and weighted samples, by quadrature over beta of the closed-form areas of slices.
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/accelerators/hybrid/conditioning.hpp"
#include "engine/accelerators/hybrid/critical_values.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::hybrid {

/// Scratch memory of one workspace analysis.
template <class S>
struct ColumnScratch {
  CriticalValueScratch beta;
  std::vector<Subinterval<S>> intervals;  ///< subintervals of beta, one for each element of `beta.intervals`
  std::vector<QuadratureCell<S>> integrals;
  StripScratch strips;
  Decomposition decomposition;  ///< decomposition of a slice whose beta is in none of the intervals
  PoseList poses;
};

/// Computes the decomposition of a slice. If the previous slice was in the same interval of beta, its decomposition is
/// updated if possible.
template <class S>
const Decomposition& decomposition_of(const Slice<double>& s, double beta, ColumnScratch<S>& scratch) {
  const auto contains = [&](const Subinterval<S>& p) { return value_of(p.lower) < beta && beta < value_of(p.upper); };
  const auto interval = std::ranges::find_if(scratch.intervals, contains);
  const bool found = interval != scratch.intervals.end();
  const auto number = static_cast<std::size_t>(interval - scratch.intervals.begin());
  Decomposition& decomposition = found ? scratch.beta.intervals[number].decomposition : scratch.decomposition;
  if (!found || !track(s, decomposition)) decompose(s, scratch.strips, decomposition);
  return decomposition;
}

/// Fills scratch.intervals with the intervals of beta on which slices are not empty and have one combinatorial type.
/// Where the intervals end depends on values only, never on derivatives.
/// @param plain    the design in double precision
/// @param by_beta  the design with zero derivatives, for derivatives with respect to beta
template <class S>
void find_outer_intervals(const SlicedDesign<S>& d, const SlicedDesign<double>& plain,
                          const SlicedDesign<Dual<1>>& by_beta, ColumnScratch<S>& scratch) {
  find_beta_intervals(plain, by_beta, scratch.beta);
  scratch.intervals.clear();
  for (std::size_t i = 0; i < scratch.beta.count; ++i) {
    const BetaInterval& s = scratch.beta.intervals[i];
    const bool first = s.lower == plain.l.beta_min, last = s.upper == plain.l.beta_max;
    const bool joins = i > 0 && scratch.beta.intervals[i - 1].upper == s.lower;
    const S lower = first        ? d.l.beta_min
                    : joins      ? scratch.intervals.back().upper
                    : s.at_lower ? lift_critical_value(d, by_beta, s.lower, *s.at_lower)
                                 : S(s.lower);
    const S upper = last         ? d.l.beta_max
                    : s.at_upper ? lift_critical_value(d, by_beta, s.upper, *s.at_upper)
                                 : S(s.upper);
    const bool sqrt_at_lower = !first && (!s.at_lower || has_sqrt_singularity(*s.at_lower)),
               sqrt_at_upper = !last && (!s.at_upper || has_sqrt_singularity(*s.at_upper));
    scratch.intervals.push_back({lower, upper, sqrt_at_lower, sqrt_at_upper});
  }
}

/// Area of the slice at one beta, in closed form [m^2].
template <class S>
S area_at(const SlicedDesign<S>& d, const S& beta, ColumnScratch<S>& scratch) {
  const Slice<S> s = slice(d, beta);
  return area(s, decomposition_of(values(s), value_of(beta), scratch));
}

/// Estimate of the rounding error of the integral of area_at() over the intervals of beta [m^2 rad].
template <class S>
double roundoff(const SlicedDesign<S>& d, const std::vector<Subinterval<S>>& intervals) {
  if (intervals.empty()) return 0;
  double size = value_of(max(d.g.L1, max(d.g.L2, d.g.L3)));  // magnitude of the terms that cancel in the area
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(value_of(d.lo[i])) + std::fabs(value_of(d.hi[i]));
  return 4e-16 * size * value_of(d.z_high) * (value_of(intervals.back().upper) - value_of(intervals.front().lower));
}

/// Volume of (x, z, beta): the integral of the areas of slices over beta [m^2 rad].
template <class S>
Integral<S> volume(const SlicedDesign<S>& d, double tolerance, ColumnScratch<S>& scratch) {
  return integrate<S>([&](const S& beta) { return area_at(d, beta, scratch); }, scratch.intervals, tolerance,
                      roundoff(d, scratch.intervals), scratch.integrals, {.rule = patterson_rule()});
}

/// Calls visit(z, length of the column of x, weight) at the nodes of a quadrature rule over z, in every strip of the
/// slice.
template <class S, class Visit>
void visit_columns(const SlicedDesign<S>& d, const S& beta, const GaussRule& rule, ColumnScratch<S>& scratch,
                   const Visit& visit) {
  const Slice<S> s = slice(d, beta);
  for (const Strip& strip : decomposition_of(values(s), value_of(beta), scratch).strips) {
    const Subinterval<S> interval{height(s, strip.from), height(s, strip.to), true, true};
    visit_nodes(interval, rule, [&](const S& z, const S& jacobian, double weight) {
      visit(z, S(edge_at(s, strip.right, z) - edge_at(s, strip.left, z)), S(jacobian * weight));
    });
  }
}

}  // namespace pkm::hybrid
