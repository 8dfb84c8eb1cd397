#include "engine/optimisers/solvers/optimality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/eigen_solvers.hpp"

#include "engine/math/non_negative_least_squares.hpp"

namespace pkm {
namespace {

// Distance from a bound or constraint, relative to the variable's range, within which it is active.
constexpr double kActivityTolerance = 1e-7;

double max_abs(std::span<const double> components) {
  double maximum = 0;
  for (const double component : components) maximum = std::max(maximum, std::fabs(component));
  return maximum;
}

}  // namespace

Optimality evaluate_kkt(std::span<const double> u, std::span<const double> gradient, std::span<const double> margins,
                        std::span<const double> margin_jacobian) {
  const std::size_t n = u.size();
  Optimality result;
  std::vector<std::vector<double>> columns;
  for (std::size_t m = 0; m < margins.size(); ++m) {
    const auto derivatives = margin_jacobian.subspan(m * n, n);
    if (!(margins[m] <= kActivityTolerance * max_abs(derivatives))) continue;
    columns.emplace_back(derivatives.begin(), derivatives.end());
    result.margins.push_back({.margin = m});
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const bool upper : {false, true}) {
      if (!((upper ? 1 - u[i] : u[i]) <= kActivityTolerance)) continue;
      columns.emplace_back(n, 0.0);
      columns.back()[i] = upper ? -1 : 1;
      result.bounds.push_back({.variable = i, .upper = upper});
    }
  std::vector<double> residual(gradient.begin(), gradient.end()), multipliers;
  try {
    multipliers = non_negative_least_squares(columns, residual);
  } catch (const std::runtime_error&) {  // the multipliers cannot be computed, therefore the residual is unknown
    return {.optimality = std::numeric_limits<double>::quiet_NaN(), .bounds = {}, .margins = {}};
  }
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t i = 0; i < n; ++i) residual[i] -= multipliers[k] * columns[k][i];
  auto multiplier = multipliers.begin();
  for (ActiveConstraint& margin : result.margins) margin.multiplier = *multiplier++;
  for (ActiveBound& bound : result.bounds) bound.multiplier = *multiplier++;
  result.optimality = max_abs(residual);
  return result;
}

std::optional<std::vector<double>> project_onto_active_constraints(const std::vector<double>& point,
                                                                   std::span<const double> margins,
                                                                   std::span<const double> margin_jacobian,
                                                                   double activity_tolerance) {
  // Value of the linearised active constraints at the projected point: slightly above 0, to allow for rounding errors.
  constexpr double kRoundingAllowance = 1e-14;
  const std::size_t n = point.size();
  std::vector<std::size_t> free, active;
  for (std::size_t i = 0; i < n; ++i)
    if (point[i] > 0 && point[i] < 1) free.push_back(i);
  for (std::size_t m = 0; m < margins.size(); ++m)
    if (std::fabs(margins[m]) <= activity_tolerance * max_abs(margin_jacobian.subspan(m * n, n))) active.push_back(m);
  if (active.empty() || free.empty()) return std::nullopt;
  Eigen::MatrixXd jacobian(active.size(), free.size());
  Eigen::VectorXd rhs(active.size());
  for (Eigen::Index r = 0; r < jacobian.rows(); ++r) {
    const std::size_t m = active[static_cast<std::size_t>(r)];
    rhs(r) = kRoundingAllowance - margins[m];
    for (Eigen::Index c = 0; c < jacobian.cols(); ++c)
      jacobian(r, c) = margin_jacobian[m * n + free[static_cast<std::size_t>(c)]];
  }
  const Eigen::VectorXd step = jacobian.completeOrthogonalDecomposition().solve(rhs);
  std::vector<double> moved = point;
  for (Eigen::Index c = 0; c < step.size(); ++c) moved[free[static_cast<std::size_t>(c)]] += step(c);
  return moved;
}

Optimality optimality(const Problem& problem, std::span<const double> design, std::span<const double> derivatives,
                      double scale) {
  const DesignSpace& space = problem.space();
  const std::size_t n = space.dimension(), width = 1 + n, objectives = problem.objectives().size();
  const double sign = problem.objectives()[0].direction == Direction::maximise ? -1 : 1;
  const auto range = [&](std::size_t i) { return space[i].upper - space[i].lower; };
  std::vector<double> u, gradient, margins, margin_jacobian;
  for (std::size_t i = 0; i < n; ++i) {
    u.push_back(space.to_unit(i, design[i]));
    gradient.push_back(sign * derivatives[1 + i] * range(i));
  }
  for (std::size_t m = 0; m < problem.margins().size(); ++m) {
    const double* of_margin = &derivatives[(objectives + m) * width];
    margins.push_back(of_margin[0]);
    for (std::size_t i = 0; i < n; ++i) margin_jacobian.push_back(of_margin[1 + i] * range(i));
  }
  Optimality result = evaluate_kkt(u, gradient, margins, margin_jacobian);
  for (ActiveBound& bound : result.bounds) bound.multiplier /= range(bound.variable);
  scale = std::max(scale, std::fabs(derivatives[0]));
  if (scale > 0) result.optimality /= scale;
  return result;
}

}  // namespace pkm
