// Motions given by a table of times and poses: cubic splines, whose slopes at the ends are those of the cubic
// polynomials through the four outermost points.
//
// Reference: C. de Boor, "A Practical Guide to Splines", revised ed., Springer 2001, chapter IV.
#include <algorithm>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

/// Derivative at t[0] of the cubic polynomial through four points, by Lagrange's formula.
double slope_at_first(const std::array<double, 4>& t, const std::array<double, 4>& x) {
  double slope = 0;
  for (std::size_t j = 1; j < 4; ++j) {
    double factor = 1 / (t[j] - t[0]);
    for (std::size_t k = 1; k < 4; ++k)
      if (k != j) factor *= (t[0] - t[k]) / (t[j] - t[k]);
    slope += factor * (x[j] - x[0]);
  }
  return slope;
}

/// Slopes at the knots of the cubic spline through the points: a tridiagonal system for a continuous second derivative.
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& x) {
  const std::size_t n = t.size();
  std::vector<double> slopes(n), diagonal(n, 1.0);
  slopes[0] = slope_at_first({t[0], t[1], t[2], t[3]}, {x[0], x[1], x[2], x[3]});
  slopes[n - 1] = slope_at_first({t[n - 1], t[n - 2], t[n - 3], t[n - 4]}, {x[n - 1], x[n - 2], x[n - 3], x[n - 4]});
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {  // elimination of the elements below the diagonal
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    const double right = 3 * ((x[i] - x[i - 1]) * after / before + (x[i + 1] - x[i]) * before / after);
    diagonal[i] = 2 * (before + after) - after * upper[i - 1];
    upper[i] = before / diagonal[i];
    slopes[i] = (right - after * slopes[i - 1]) / diagonal[i];
  }
  for (std::size_t i = n - 1; i-- > 1;) slopes[i] -= upper[i] * slopes[i + 1];
  return slopes;
}

}  // namespace

std::shared_ptr<const Motion> motion_from_table(const std::vector<double>& times,
                                                const std::vector<std::vector<double>>& coordinates) {
  PKM_EXPECTS(times.size() >= 4 && times.front() == 0);
  std::vector<std::vector<double>> slopes;
  for (const std::vector<double>& values : coordinates) slopes.push_back(spline_slopes(times, values));
  const auto at = [times, coordinates, slopes](double time) {
    const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    const auto k = static_cast<std::size_t>(after - times.begin());
    const double h = times[k] - times[k - 1], u = (time - times[k - 1]) / h;
    MotionSample sample;
    sample.time = time;
    sample.pose = sample.velocity = sample.acceleration = AxisVector<double>(coordinates.size());
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      // Hermite form of the spline in an interval: x = a + u (b + u (c + u d)).
      const double a = coordinates[i][k - 1], b = h * slopes[i][k - 1];
      const double rise = coordinates[i][k] - a, end = h * slopes[i][k];
      const double c = 3 * rise - 2 * b - end, d = b + end - 2 * rise;
      sample.pose[i] = a + u * (b + u * (c + u * d));
      sample.velocity[i] = (b + u * (2 * c + u * (3 * d))) / h;
      sample.acceleration[i] = (2 * c + 6 * d * u) / (h * h);
    }
    return sample;
  };
  return std::make_shared<const Motion>(times.back(), at, [](TimeGraph&) -> std::vector<expression::Node> {
    throw std::invalid_argument("a motion that is given by a table has no formulas; give it in TOML");
  });
}

}  // namespace pkm
