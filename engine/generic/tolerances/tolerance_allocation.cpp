#include "engine/generic/tolerances/tolerance_allocation.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::generic {

std::vector<double> allocate_tolerances(const std::vector<double>& costs, const std::vector<ToleranceRow>& rows) {
  constexpr int kMaxIterations = 10000;
  constexpr double kAccuracy = 1e-6;  // accepted relative violation of a row, and weighted mean of slack / bound
  std::vector<double> tolerances(costs.size()), multipliers(rows.size(), 1.0);
  // Ratio of the left side of a row to its bound.
  const auto usage = [&](const ToleranceRow& row) {
    double sum = 0;
    for (std::size_t i = 0; i < tolerances.size(); ++i) sum += row.coefficients[i] * tolerances[i];
    return sum / row.bound;
  };
  double maximum = 0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (std::size_t i = 0; i < tolerances.size(); ++i) {
      double price = 0;
      for (std::size_t r = 0; r < rows.size(); ++r) price += multipliers[r] * rows[r].coefficients[i] / rows[r].bound;
      tolerances[i] = std::sqrt(costs[i] / price);
    }
    // Stop if complementary slackness holds: for each row, the multiplier is 0, or the left side equals the bound.
    maximum = 0;
    double total = 0, slack = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double used = usage(rows[r]);
      maximum = std::max(maximum, used);
      total += multipliers[r];
      slack += multipliers[r] * std::fabs(1 - used);
      multipliers[r] = std::max(multipliers[r] * used, 1e-300);
    }
    if (maximum < 1 + kAccuracy && slack < kAccuracy * total) break;
  }
  for (double& tolerance : tolerances) tolerance /= maximum;
  return tolerances;
}

}  // namespace pkm::generic
