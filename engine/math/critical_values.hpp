// Divides the range of an outer coordinate at its critical values, so that a slice has one combinatorial type between
// two of them.
//
// The measure of a slice is a smooth function of the outer coordinate while the combinatorial type is constant.
// Critical values with a closed form are given first. Between them, the signature of the type is sampled, and every
// change is bracketed to rounding accuracy. Critical values depend on the design: those with a closed form are dual
// numbers with derivatives, and for the others the mechanism supplies the derivative by the implicit function theorem.
// A critical value at which the measure is discontinuous must be given in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/math/quadrature.hpp"
#include "engine/math/roots.hpp"

namespace pkm {

/// A critical value of the outer coordinate.
template <class S>
struct CriticalValue {
  S at;
  bool root_below = false;  ///< the measure has a square-root singularity when `at` is approached from below
  bool root_above = false;  ///< the measure has a square-root singularity when `at` is approached from above
};

/// A root t(p) of f(p, t) = 0 with its derivatives with respect to the design parameters p, by the implicit function
/// theorem: dt/dp = -(df/dp) / (df/dt).
/// @param t     value of the root
/// @param f     f with its derivatives df/dp at the root; its value is ignored
/// @param by_t  df/dt at the root; if it is 0, the derivatives of the result are 0
template <class S>
S implicit_root(double t, const S& f, double by_t) {
  return std::fabs(by_t) > 0 ? S(t - (f - value_of(f)) / by_t) : S(t);
}

/// Finds the subintervals between critical values on which slices are not empty.
/// @param values          both bounds of the outer coordinate and the known critical values, in ascending order
/// @param merge_distance  closer critical values are merged
/// @param merge_roots     whether two subintervals of the same signature are merged even if the critical value between
///                        them has a square-root singularity
/// @param changes         changes(low, high, split) calls split(critical value, signature below it) for each change of
///                        the signature in (low, high), in ascending order, and returns the signature below `high`. A
///                        signature that converts to false means an empty slice
/// @param intervals       receives the subintervals
template <class Signature, class S, class Changes>
void find_subintervals(const std::vector<CriticalValue<S>>& values, double merge_distance, bool merge_roots,
                       const Changes& changes, std::vector<Subinterval<S>>& intervals) {
  intervals.clear();
  if (values.empty()) return;
  Signature before{};  // signature of the previous subinterval; default-constructed before the first one
  CriticalValue<S> from = values.front();
  const auto split = [&](const CriticalValue<S>& to, const Signature& now) {
    const bool joins = !intervals.empty() && now == before && value_of(intervals.back().upper) == value_of(from.at) &&
                       (merge_roots || !(from.root_below || from.root_above));
    if (now && joins) {
      intervals.back().upper = to.at;
      intervals.back().sqrt_at_upper = to.root_below;
    } else if (now) {
      intervals.push_back({from.at, to.at, from.root_above, to.root_below});
    }
    before = now;
    from = to;
  };
  for (std::size_t i = 1; i < values.size(); ++i) {
    const CriticalValue<S>& to = values[i];
    const double low = value_of(from.at), high = value_of(to.at);
    if (high - low < merge_distance) {
      from.root_above = from.root_above || to.root_above;
      if (!intervals.empty() && value_of(intervals.back().upper) == low)
        intervals.back().sqrt_at_upper = intervals.back().sqrt_at_upper || to.root_below;
      continue;
    }
    split(to, changes(low, high, split));
  }
}

/// Finds the subintervals between critical values on which slices are not empty. Changes of the signature are located
/// by sampling and bisection.
/// @param values     both bounds of the outer coordinate and the known critical values, in any order; sorted here
/// @param signature  signature(x): signature of the slice at x; 0 if the slice is empty
/// @param lift       lift(x): converts a critical value x, found by bisection, to a number with derivatives
/// @param samples    number of samples of the signature over the whole range
template <class S, class Signature, class Lift>
void find_subintervals(std::vector<CriticalValue<S>>& values, const Signature& signature, const Lift& lift, int samples,
                       std::vector<Subinterval<S>>& intervals) {
  intervals.clear();
  if (values.empty()) return;
  std::sort(values.begin(), values.end(),
            [](const CriticalValue<S>& a, const CriticalValue<S>& b) { return value_of(a.at) < value_of(b.at); });
  const double whole = value_of(values.back().at) - value_of(values.front().at);
  if (!(whole > 0)) return;
  const auto changes = [&](double low, double high, const auto& split) {
    const double length = high - low;
    const int steps = std::max(1, static_cast<int>(std::ceil(samples * length / whole)));
    const double inset = std::min(
        0.25 * length, 1e-7 * whole);  // very close to a critical value, the signature depends on rounding errors
    double at = low + inset;
    std::uint64_t now = signature(at);
    for (int k = 1; k <= steps; ++k) {
      const double next = k == steps ? high - inset : low + length * (k / static_cast<double>(steps));
      const std::uint64_t then = signature(next);
      for (int more = 0; more < 8 && now != then; ++more) {  // up to 8 critical values between two samples
        const auto is_unchanged = [&](double x) { return signature(x) == now; };
        const double width = 1e-15 * (whole + std::fabs(next));
        at = bisect(is_unchanged, {.with = at, .without = next}, width).without;
        split(CriticalValue<S>{lift(at), true, true}, now);
        now = signature(at);
      }
      at = next;
      now = then;
    }
    return now;
  };
  find_subintervals<std::uint64_t>(values, 1e-13 * whole, true, changes, intervals);
}

}  // namespace pkm
