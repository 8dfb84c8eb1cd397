#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/roots.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Integral over one clear interval of a column of the length of y in which the stroke allows the pose,
///
///   max(0, L0 - max(2 h_1, 2 h_2, h_1 + h_2 + a sin theta)),   theta >= 0.
///
/// where h_j is half the distance of the two sliders of limb j. The leaning limb (that with the greater inclination
/// beta) has the smaller h. Both h increase with z, and so does their difference, which is negative or 0: the length
/// has at most one kink and one root.
double integral_of_stroke(const SlicedDesign<double>& d, const Slice<double>& t, const Column<double>& column,
                          const ClosedInterval& clear) {
  static const GaussRule rule = gauss_legendre(12);
  const Geometry<double>& g = d.g;
  const double shift = g.a * t.sin_theta;
  const auto h = [&](double rise, std::size_t j) {
    const double z_c = column.z_c(d, rise, j);
    return sqrt_or_zero((g.l_u - z_c) * (g.l_u + z_c));
  };
  const auto h_difference = [&](double rise) { return shift + h(rise, column.leaning) - h(rise, 1 - column.leaning); };
  const auto length = [&](double rise) {
    const double other = h(rise, 1 - column.leaning);
    return g.L0 - std::fmax(2 * other, other + h(rise, column.leaning) + shift);
  };
  const auto root_below = [&](const auto& function, double upper) {
    const double low = function(clear.lower), high = function(upper), width = 1e-13 * (clear.upper - clear.lower);
    return (low > 0) == (high > 0) ? upper : refine_root(function, clear.lower, low, upper, high, width);
  };
  if (!(length(clear.lower) > 0)) return 0;
  const double last = root_below(length, clear.upper), kink = root_below(h_difference, last);
  double sum = 0;
  for (const auto& [low, high] : {std::pair{clear.lower, kink}, std::pair{kink, last}}) {
    if (!(low < high)) continue;
    const Subinterval<double> interval{low, high, low == 0, false};  // h can behave like a square root at 0
    visit_nodes(interval, rule,
                [&](double rise, double jacobian, double weight) { sum += length(rise) * jacobian * weight; });
  }
  return sum;
}

/// Total length [m] of the intervals of z in a column in which the links are clear or, with `over_y`, the integral over
/// y of this length [m^2].
double measure(const SlicedDesign<double>& d, const Slice<double>& t, const Column<double>& column,
               const ClearanceTest& test, bool over_y, ClearanceScratch& scratch) {
  double sum = 0;
  for (const ClosedInterval& clear : test.clear_heights(d, t, column, scratch))
    sum += over_y ? integral_of_stroke(d, t, column, clear) : clear.upper - clear.lower;
  return sum;
}

Slice<double> slice_of(const SlicedDesign<double>& d, double theta, bool over_y) {
  const auto [s, c] = sincos(theta);
  if (!over_y) return slice(d, s, c);
  Slice<double> t = slice_range(d, s, c);
  t.depth = {d.z_low - d.z_high, d.z_low - d.z_high};  // the stroke does not limit z here, because it limits y instead
  return t;
}

}  // namespace

Integral<double> clear_volume_by_rule(const SlicedDesign<double>& d, const ClearanceTest& test, bool over_y,
                                      const GaussRule& theta_rule, const GaussRule& inner_rule,
                                      ColumnScratch<double>& scratch) {
  find_theta_intervals(d, scratch.critical_values, scratch.intervals);
  Integral<double> result;
  visit_nodes(scratch.intervals, theta_rule, [&](double theta, double theta_jacobian, double theta_weight) {
    const double outer = 2 * theta_weight * theta_jacobian;
    const Slice<double> t = slice_of(d, theta, over_y);
    visit_halves(d, t, &test, scratch, [&](const HalfSlice<double>& h, std::size_t leaning, double images) {
      visit_nodes(scratch.deltas, inner_rule, [&](double delta, double jacobian, double weight) {
        const Column<double> c = column(d, t, h, leaning, delta);
        result.value +=
            images * outer * weight * jacobian * c.derivative * measure(d, t, c, test, over_y, scratch.clearance);
        ++result.evaluations;
      });
    });
  });
  return result;
}

Integral<double> clear_volume(const SlicedDesign<double>& d, const ClearanceTest& test, bool over_y, double tolerance,
                              ColumnScratch<double>& scratch) {
  // Tolerance of the inner quadrature relative to that of the outer one; larger errors of the inner integral would look
  // like kinks to the outer rule.
  constexpr double kInnerTolerance = 0.02;
  const Quadrature outer{.regularity = Regularity::kinks}, inner{.regularity = Regularity::kinks, .depth = 12};
  static const GaussRule coarse = gauss_legendre(5);
  // This call computes a first estimate of the volume, and finds the intervals of integration.
  const Integral<double> guess = clear_volume_by_rule(d, test, over_y, coarse, coarse, scratch);
  double range = 0;
  for (const Subinterval<double>& interval : scratch.intervals) range += interval.upper - interval.lower;
  const double aim = std::fmax(tolerance, kFinestClearTolerance);
  // Accepted absolute error of a slice; at least an area or volume that is negligible relative to the size of the
  // links.
  const double negligible = 1e-9 * d.g.l_d * d.g.l_u * (over_y ? d.g.L0 : 1);
  const double inner_error = std::fmax(negligible, kInnerTolerance * aim * guess.value / (2 * range));
  double worst = 0;  // maximum error of a single slice
  std::int64_t columns = guess.evaluations;
  const auto area_at = [&](double theta) {
    const Slice<double> t = slice_of(d, theta, over_y);
    double area = 0, error = 0;
    visit_halves(d, t, &test, scratch, [&](const HalfSlice<double>& h, std::size_t leaning, double images) {
      const auto measure_at = [&](double delta) {
        check_stop();
        const Column<double> c = column(d, t, h, leaning, delta);
        return c.derivative * measure(d, t, c, test, over_y, scratch.clearance);
      };
      for (const Subinterval<double>& interval : scratch.deltas) {
        const Integral<double> found = integrate_interval(measure_at, interval, inner_error, inner);
        area += images * found.value;
        error += images * found.error;
        columns += found.evaluations;
      }
    });
    worst = std::fmax(worst, error);
    return area;
  };
  Integral<double> result =
      integrate<double>(area_at, scratch.intervals, aim, negligible * range, scratch.integrals, outer);
  result.value *= 2;  // the volume of theta < 0 equals that of theta > 0
  result.error = 2 * (result.error + worst * range);
  result.evaluations = columns;
  return result;
}

}  // namespace pkm::four_ppa_two_par
