#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"

#include "engine/core/stop.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Integral along one clear part of a column of the length of y on which the stroke allows the pose,
///
///   max(0, L0 - max(2 h_1, 2 h_2, h_1 + h_2 + a sin theta)),   theta >= 0.
///
/// The limb that leans more has the lesser h. Both h grow with z, and so does their difference, towards 0: the length
/// has one kink at most, and reaches 0 once.
double integral_of_stroke(const Frame<double>& f, const Section<double>& t, const Column<double>& column,
                          const Part& part) {
  static const GaussRule rule = gauss_legendre(12);
  const Geometry<double>& g = f.g;
  const double shift = g.a * t.sin_theta;
  const auto h = [&](double rise, std::size_t j) {
    const double z_c = column.z_c(f, rise, j);
    return sqrt_or_zero((g.l_u - z_c) * (g.l_u + z_c));
  };
  const auto apart = [&](double rise) { return shift + h(rise, column.leaning) - h(rise, 1 - column.leaning); };
  const auto length = [&](double rise) {
    const double other = h(rise, 1 - column.leaning);
    return g.L0 - std::fmax(2 * other, other + h(rise, column.leaning) + shift);
  };
  const auto root_below = [&](const auto& function, double upper) {
    const double low = function(part.lower), high = function(upper), width = 1e-13 * (part.upper - part.lower);
    return (low > 0) == (high > 0) ? upper : bracketed_root(function, part.lower, low, upper, high, width);
  };
  if (!(length(part.lower) > 0)) return 0;
  const double last = root_below(length, part.upper), kink = root_below(apart, last);
  double sum = 0;
  for (const auto& [low, high] : {std::pair{part.lower, kink}, std::pair{kink, last}}) {
    if (!(low < high)) continue;
    const Piece<double> piece{low, high, low == 0, false};  // h may start like a root
    visit_nodes(piece, rule,
                [&](double rise, double jacobian, double weight) { sum += length(rise) * jacobian * weight; });
  }
  return sum;
}

/// What one column adds to a section: the length of its clear parts, or that times the length of y.
double measure(const Frame<double>& f, const Section<double>& t, const Column<double>& column,
               const ClearanceTest& test, bool over_y, ClearanceScratch& scratch) {
  double sum = 0;
  for (const Part& part : test.clear_parts(f, t, column, scratch))
    sum += over_y ? integral_of_stroke(f, t, column, part) : part.upper - part.lower;
  return sum;
}

Section<double> section_of(const Frame<double>& f, double theta, bool over_y) {
  const auto [s, c] = sincos(theta);
  if (!over_y) return section(f, s, c);
  Section<double> t = section_range(f, s, c);
  t.depth = {f.z_low - f.z_high, f.z_low - f.z_high};  // the stroke is counted in y
  return t;
}

/// Calls add(half, leaning, weight) for the halves of a section that do not follow from symmetry, with the pieces of
/// delta in scratch.ranges.
template <class Add>
void visit_halves(const Frame<double>& f, const Section<double>& t, const ClearanceTest& test,
                  ColumnScratch<double>& scratch, const Add& add) {
  if (t.empty) return;
  const bool symmetric = t.depth[0] == t.depth[1];
  for (std::size_t leaning = 0; leaning < (symmetric ? 1u : 2u); ++leaning) {
    const Half<double> h = half_section(t, leaning);
    if (h.empty) continue;
    feasible_ranges(f, t, h, leaning, &test, scratch);
    add(h, leaning, symmetric ? 2.0 : 1.0);
  }
}

/// The volume by fixed rules in theta and delta.
Integral<double> by_rule(const Frame<double>& f, const ClearanceTest& test, bool over_y, const GaussRule& theta_rule,
                         const GaussRule& inner_rule, ColumnScratch<double>& scratch) {
  Integral<double> result;
  visit_nodes(scratch.pieces, theta_rule, [&](double theta, double theta_jacobian, double theta_weight) {
    const double outer = 2 * theta_weight * theta_jacobian;
    const Section<double> t = section_of(f, theta, over_y);
    visit_halves(f, t, test, scratch, [&](const Half<double>& h, std::size_t leaning, double images) {
      visit_nodes(scratch.ranges, inner_rule, [&](double delta, double jacobian, double weight) {
        const Column<double> c = column(f, t, h, leaning, delta);
        result.value +=
            images * outer * weight * jacobian * c.slope * measure(f, t, c, test, over_y, scratch.clearance);
        ++result.evaluations;
      });
    });
  });
  return result;
}

}  // namespace

Integral<double> clear_volume(const Frame<double>& f, const ClearanceTest& test, bool over_y, double tolerance,
                              ColumnScratch<double>& scratch) {
  constexpr double kInner = 0.02;  // so that the outer rule does not take the inner one's error for kinks
  const Quadrature outer{.between = Between::kinks}, inner{.between = Between::kinks, .depth = 12};
  static const GaussRule coarse = gauss_legendre(5);
  find_pieces(f, scratch.breaks, scratch.pieces);
  double range = 0;
  for (const Piece<double>& piece : scratch.pieces) range += piece.upper - piece.lower;
  const double aim = std::fmax(tolerance, kFinestClearTolerance);
  const Integral<double> guess = by_rule(f, test, over_y, coarse, coarse, scratch);
  // Absolute errors of a section that need not be improved; for a volume next to nothing, a trifle of the links' size.
  const double trifle = 1e-9 * f.g.l_d * f.g.l_u * (over_y ? f.g.L0 : 1);
  const double inner_error = std::fmax(trifle, kInner * aim * guess.value / (2 * range));
  double worst = 0;  // error of all sections
  std::int64_t columns = guess.evaluations;
  const auto area_at = [&](double theta) {
    const Section<double> t = section_of(f, theta, over_y);
    double area = 0, error = 0;
    visit_halves(f, t, test, scratch, [&](const Half<double>& h, std::size_t leaning, double weight) {
      const auto strip = [&](double delta) {
        check_stop();
        const Column<double> c = column(f, t, h, leaning, delta);
        return c.slope * measure(f, t, c, test, over_y, scratch.clearance);
      };
      for (const Piece<double>& piece : scratch.ranges) {
        const Integral<double> found = integrate_interval(strip, piece, inner_error, inner);
        area += weight * found.value;
        error += weight * found.error;
        columns += found.evaluations;
      }
    });
    worst = std::fmax(worst, error);
    return area;
  };
  Integral<double> result = integrate<double>(area_at, scratch.pieces, aim, trifle * range, scratch.integrals, outer);
  result.value *= 2;  // even in theta
  result.error = 2 * (result.error + worst * range);
  result.evaluations = columns;
  return result;
}

Integral<double> clear_volume_by_rule(const Frame<double>& f, const ClearanceTest& test, const GaussRule& theta_rule,
                                      const GaussRule& inner_rule, ColumnScratch<double>& scratch) {
  find_pieces(f, scratch.breaks, scratch.pieces);
  return by_rule(f, test, false, theta_rule, inner_rule, scratch);
}

}  // namespace pkm::four_ppa_two_par
