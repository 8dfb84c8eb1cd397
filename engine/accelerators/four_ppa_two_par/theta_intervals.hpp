// 4PPa-2PaR: the intervals of theta on which the area of the slice is smooth.
//
// The formula of the area changes at critical values of theta: where another limit becomes active at a bound of delta,
// where the stroke begins to limit z or leaves a limb no feasible z, where sin_par_min begins to exclude poses at x =
// b/2, and where the depth Delta equals a bound of delta. All but the last have a closed form in cos theta or sin
// theta. The last has a closed form while the stroke is inactive, and is otherwise the root of a switching function.
// Critical values in closed form are dual numbers; roots get their derivatives by the implicit function theorem. The
// area is continuous at all critical values. Everything is even in theta, so only theta >= 0 is considered.
#pragma once

#include <algorithm>
#include <optional>
#include <type_traits>

#include "engine/accelerators/four_ppa_two_par/slice.hpp"
#include "engine/math/critical_values.hpp"
#include "engine/math/dual.hpp"

namespace pkm::four_ppa_two_par {

/// Continuous functions of theta whose signs select the formula of the area: comparisons of the depths with the bounds
/// of delta. Delta_1 <= Delta_2, because y <= L0/2 and theta >= 0.
inline constexpr std::size_t kSwitchingFunctions = 6;
template <class S>
std::array<S, kSwitchingFunctions> switching_functions(const Slice<S>& t) {
  const S &D1 = t.depth[0], &D2 = t.depth[1];
  return {D1 - t.delta_end, D2 - t.delta_end,      D1 - t.delta_low,
          D2 - t.delta_low, D2 - D1 - t.delta_end, D2 - D1 - t.delta_low};
}
template <class S>
S switching_function(const SlicedDesign<S>& d, std::size_t index, const S& theta) {
  const auto [s, c] = sincos(theta);
  return switching_functions(slice(d, s, c))[index];
}

/// Properties of a slice that, together with the signs of the switching functions, select the formula of its area.
struct Formula {
  EndKind end;
  bool low;                         ///< true if delta_low > 0
  bool stroke_limits_1;             ///< true if the stroke limits the depth of limb 1
  bool stroke_limits_2;             ///< true if the stroke limits the depth of limb 2
  bool stroke_limits_2_at_far_end;  ///< true if the stroke that limits limb 2 is the one to the far end of the rail
  bool operator==(const Formula&) const = default;
};
/// Combinatorial type of a slice: two slices with equal signatures have the same formula of the area.
struct Signature {
  std::optional<Formula> formula;                   ///< std::nullopt: the slice is empty
  std::array<double, kSwitchingFunctions> value{};  ///< values of the switching functions; compared by sign

  explicit operator bool() const { return formula.has_value(); }
  bool operator==(const Signature& other) const {
    if (formula != other.formula) return false;
    for (std::size_t i = 0; formula && i < kSwitchingFunctions; ++i)
      if ((value[i] > 0) != (other.value[i] > 0)) return false;
    return true;
  }
};

Signature signature(const SlicedDesign<double>& d, double theta);

/// A root of one of the switching functions.
struct Crossing {
  double theta;
  std::size_t function;
};
/// Finds the first root in (low, high], to rounding accuracy, of those switching functions whose signs differ between
/// two signatures with the same formula.
Crossing find_crossing(const SlicedDesign<double>& d, double low, const Signature& at_low, double high,
                       const Signature& at_high);

/// Converts a design to another scalar type, with zero derivatives.
template <class To, class From>
SlicedDesign<To> constant_design(const SlicedDesign<From>& d) {
  return sliced_design(constant<To>(d.g), constant<To>(d.l), To(value_of(d.y)));
}

/// The theta of a root of a switching function, with derivatives by the implicit function theorem.
template <class S>
S lift_crossing(const SlicedDesign<S>& d, const Crossing& crossing) {
  if constexpr (!std::is_same_v<S, double>) {
    const S value = switching_function(d, crossing.function, S(crossing.theta));
    const auto by_theta = Dual<1>::variable(crossing.theta, 0);
    const double derivative = switching_function(constant_design<Dual<1>>(d), crossing.function, by_theta).v[0];
    // A zero derivative means a double root, which bounds an interval of length 0.
    return implicit_root(crossing.theta, value, derivative);
  } else {
    return crossing.theta;
  }
}

/// Adds the critical values of theta that have a closed form, in no particular order.
template <class S>
void add_closed_form_critical_values(const SlicedDesign<S>& d, std::vector<CriticalValue<S>>& values) {
  const Geometry<S>& g = d.g;
  const Limits<S>& l = d.l;
  // Adds the theta at which w, or shift = (a/2) sin theta, has a given value. root_below and root_above: true if the
  // area has a square-root singularity below or above this theta.
  const auto at_w = [&](const S& w, bool root_below, bool root_above) {
    const S c = (g.b - w) / g.a;
    if (value_of(c) > 0 && value_of(c) < 1) values.push_back({acos(c), root_below, root_above});
  };
  const auto at_shift = [&](const S& shift, bool root_below, bool root_above) {  // here shift = (a/2) sin theta
    const S s = shift * 2.0 / g.a;
    if (value_of(s) > 0 && value_of(s) < 1) values.push_back({asin(s), root_below, root_above});
  };
  const auto root = [](const S& x) { return sqrt_or_zero(x); };
  // theta at which w = x_1 + x_2 equals its minimum or maximum, given by beta_min, beta_max and sin_par_min
  at_w(d.x_min * 2.0, false, false);
  at_w(d.x_max * 2.0, true, false);
  at_w(d.chord_max, true, false);
  // theta at which the active limit changes from beta_max to beta_min; the area has a square-root singularity if sigma
  // of the leaning limb vanishes there
  at_w(d.x_max + d.x_min, value_of(l.cos_beta_max) < 0.1, false);
  const bool parallel = value_of(l.sin_par_min) > 0;
  const S sin_phi = l.sin_half * l.cos_half * 2.0, cos_phi = l.cos_half * l.cos_half - l.sin_half * l.sin_half;
  if (parallel) {
    // theta at which beta_1 + beta_2 = pi - phi with one limb at its limit
    at_w(g.l_d * (l.sin_beta_max + sin_phi * l.cos_beta_max + cos_phi * l.sin_beta_max), false, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min + cos_phi * l.sin_beta_min), false, false);
    // theta at which the limit beta_1 + beta_2 >= phi begins to exclude poses at x = b/2, or coincides with another
    // limit
    at_w(d.chord_min, true, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min - cos_phi * l.sin_beta_min), false, false);
    at_w(g.l_d * (l.sin_beta_max + sin_phi * l.cos_beta_max - cos_phi * l.sin_beta_max), false, false);
  }
  // theta at which the depth for unlimited stroke equals a bound of delta
  const S depth = d.z_low - d.z_high;
  const S lean = g.l_d * l.cos_beta_max + depth, other = g.l_d * l.cos_beta_min - depth;
  if (value_of(lean) < value_of(g.l_d)) {
    const S x = root(S((g.l_d - lean) * (g.l_d + lean)));
    at_w(d.x_max + x, false, false);
    at_w(d.x_max - x, false, false);
  }
  if (value_of(other) > 0) at_w(d.x_min + root(S((g.l_d - other) * (g.l_d + other))), false, false);
  const S upper = (d.chord_max - depth) * (d.chord_max + depth);
  if (value_of(upper) > 0) at_w(root(upper), false, false);
  const S lower = (d.chord_min - depth) * (d.chord_min + depth);
  if (parallel && value_of(lower) > 0) at_w(root(lower), false, false);
  // theta at which the stroke begins to limit z (with a square-root singularity on that side), or leaves a limb no
  // feasible z
  at_shift(d.y - d.stroke_free, false, true);
  at_shift(d.stroke_free - d.y, true, false);
  at_shift(g.L0 - d.stroke_free - d.y, false, true);
  at_shift(d.y - l.h_min, false, false);
  at_shift(g.L0 * 0.5 - d.y, false, false);  // theta at which the other end of the rail becomes the nearer one
}

/// Calls split(critical value, signature below it) at the roots of the switching functions between two critical values
/// with a closed form. The formula changes only at critical values with a closed form; a sample whose formula differs
/// from that in the middle is therefore at an endpoint, up to rounding, and is skipped.
/// @return the signature above the last root
template <class S, class Split>
Signature split_at_crossings(const SlicedDesign<S>& d, const SlicedDesign<double>& plain, double low, double high,
                             const Signature& middle, const Split& split) {
  constexpr int kSamples = 8;
  // Distance of the outer samples from the endpoints, relative to the interval; at an endpoint, rounding can change the
  // sign of a switching function.
  constexpr double kInset = 1e-7;
  Signature now = middle;
  double at = low;
  bool has_sample = false;
  for (int k = 0; k <= kSamples; ++k) {
    const double share = k == 0 ? kInset : k == kSamples ? 1 - kInset : k / static_cast<double>(kSamples);
    const double next = low + (high - low) * share;
    const Signature then = signature(plain, next);
    if (then.formula != middle.formula) continue;
    for (int more = 0; has_sample && more < 6 && !(now == then); ++more) {  // repeated because several signs can change
      const Crossing crossing = find_crossing(plain, at, now, next, then);
      split(CriticalValue<S>{lift_crossing(d, crossing)}, now);
      at = crossing.theta + 1e-12;
      now = signature(plain, at);
      if (now.formula != middle.formula) now = then;
    }
    at = next;
    now = then;
    has_sample = true;
  }
  return now;
}

/// Finds the intervals of theta >= 0 on which the area is positive and smooth.
/// @param values     scratch memory
/// @param intervals  receives the intervals
template <class S>
void find_theta_intervals(const SlicedDesign<S>& d, std::vector<CriticalValue<S>>& values,
                          std::vector<Subinterval<S>>& intervals) {
  values.clear();
  intervals.clear();
  if (d.empty) return;
  const SlicedDesign<double> plain = constant_design<double>(d);
  values.push_back({S(0.0)});
  add_closed_form_critical_values(d, values);
  const S last = acos(d.l.cos_theta_min);
  std::erase_if(values, [&](const CriticalValue<S>& b) { return !(value_of(b.at) < value_of(last)); });
  values.push_back({last});
  const auto in_order = [](const CriticalValue<S>& a, const CriticalValue<S>& b) {
    return value_of(a.at) < value_of(b.at);
  };
  for (auto next = values.begin(); next != values.end(); ++next)  // insertion sort, because std::stable_sort allocates
    std::rotate(std::upper_bound(values.begin(), next, *next, in_order), next, next + 1);

  constexpr double kMergeDistance = 1e-13;  // closer critical values are merged [rad]
  const auto changes = [&](double low, double high, const auto& split) {
    const Signature middle = signature(plain, 0.5 * (low + high));
    if (!middle || !(middle.formula->stroke_limits_1 || middle.formula->stroke_limits_2)) return middle;
    return split_at_crossings(d, plain, low, high, middle, split);
  };
  find_subintervals<Signature>(values, kMergeDistance, false, changes, intervals);
}

}  // namespace pkm::four_ppa_two_par
