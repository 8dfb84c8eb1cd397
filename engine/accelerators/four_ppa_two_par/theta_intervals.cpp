#include "engine/accelerators/four_ppa_two_par/theta_intervals.hpp"

#include "engine/math/roots.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Root of a switching function between two values of theta at which it has different signs, to rounding accuracy. The
/// value 0 counts as negative.
double switching_root(const SlicedDesign<double>& d, std::size_t index, double low, double at_low, double high,
                      double at_high) {
  const auto negated = [&](double theta) { return -switching_function(d, index, theta); };
  return refine_root(negated, low, -at_low, high, -at_high, 1e-15);
}

}  // namespace

Signature signature(const SlicedDesign<double>& d, double theta) {
  const auto [s, c] = sincos(theta);
  const Slice<double> t = slice(d, s, c);
  if (t.empty || !(t.depth[0] > 0)) return {};
  const auto [H1, H2] = strokes(d, d.y, s);
  const bool stroke_limits_2 = H2<d.stroke_free, far_end = d.y + d.g.a * s * 0.5> d.g.L0 * 0.5;
  return {.formula = Formula{.end = t.end,
                             .low = t.delta_low > 0,
                             .stroke_limits_1 = H1 < d.stroke_free,
                             .stroke_limits_2 = stroke_limits_2,
                             .stroke_limits_2_at_far_end = stroke_limits_2 && far_end},
          .value = switching_functions(t)};
}

Crossing find_crossing(const SlicedDesign<double>& d, double low, const Signature& at_low, double high,
                       const Signature& at_high) {
  Crossing first{high, 0};
  for (std::size_t i = 0; i < kSwitchingFunctions; ++i) {
    if ((at_low.value[i] > 0) == (at_high.value[i] > 0)) continue;
    const double theta = switching_root(d, i, low, at_low.value[i], high, at_high.value[i]);
    if (theta <= first.theta) first = {theta, i};
  }
  return first;
}

}  // namespace pkm::four_ppa_two_par
