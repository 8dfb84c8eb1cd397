#include "engine/optimisers/solvers/optimality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/QR>

namespace pkm {
namespace {

constexpr double kNearBound = 1e-7;  // of the variable's range

double largest(std::span<const double> components) {
  double most = 0;
  for (const double component : components) most = std::max(most, std::fabs(component));
  return most;
}

Eigen::MatrixXd matrix(const std::vector<std::vector<double>>& columns, const std::vector<std::size_t>& which,
                       std::size_t rows) {
  Eigen::MatrixXd m(rows, which.size());
  for (std::size_t k = 0; k < which.size(); ++k)
    for (std::size_t i = 0; i < rows; ++i)
      m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = columns[which[k]][i];
  return m;
}

}  // namespace

std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               const std::vector<double>& b) {
  const std::size_t n = columns.size(), rows = b.size();
  const Eigen::Map<const Eigen::VectorXd> target(b.data(), static_cast<Eigen::Index>(rows));
  std::vector<double> x(n, 0.0);
  std::vector<bool> in(n, false);
  for (std::size_t step = 0; step < 10 * n + 10; ++step) {
    Eigen::VectorXd residual = target;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < rows; ++i) residual(static_cast<Eigen::Index>(i)) -= columns[k][i] * x[k];
    // the column that promises most
    std::size_t enter = n;
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (in[k]) continue;
      double gain = 0, size = 0;
      for (std::size_t i = 0; i < rows; ++i) {
        gain += columns[k][i] * residual(static_cast<Eigen::Index>(i));
        size += columns[k][i] * columns[k][i];
      }
      if (gain > most && gain > 1e-13 * std::sqrt(size) * (target.norm() + 1e-300)) {
        most = gain;
        enter = k;
      }
    }
    if (enter == n) return x;
    in[enter] = true;
    while (true) {
      std::vector<std::size_t> which;
      for (std::size_t k = 0; k < n; ++k)
        if (in[k]) which.push_back(k);
      const Eigen::VectorXd trial = matrix(columns, which, rows).colPivHouseholderQr().solve(target);
      double reach = 1;  // how far from x towards the trial all stay positive
      for (std::size_t k = 0; k < which.size(); ++k) {
        const double to = trial(static_cast<Eigen::Index>(k)), from = x[which[k]];
        if (to <= 0) reach = std::min(reach, from / (from - to));
      }
      if (!(reach >= 0)) reach = 0;  // 0/0: a column that has just entered turns out dependent
      for (std::size_t k = 0; k < which.size(); ++k)
        x[which[k]] += reach * (trial(static_cast<Eigen::Index>(k)) - x[which[k]]);
      if (reach == 1) break;
      for (std::size_t k = 0; k < which.size(); ++k)
        if (trial(static_cast<Eigen::Index>(k)) <= 0 && x[which[k]] <= 1e-300) {
          x[which[k]] = 0;
          in[which[k]] = false;
        }
      if (std::none_of(in.begin(), in.end(), [](bool member) { return member; })) break;
    }
  }
  throw std::runtime_error("the multipliers do not settle");
}

Optimality first_order(std::span<const double> u, std::span<const double> gradient, std::span<const double> margins,
                       std::span<const double> margin_gradient) {
  const std::size_t n = u.size();
  Optimality result;
  std::vector<std::vector<double>> columns;
  for (std::size_t m = 0; m < margins.size(); ++m) {
    const auto slope = margin_gradient.subspan(m * n, n);
    if (!(margins[m] <= kNearBound * largest(slope))) continue;
    columns.emplace_back(slope.begin(), slope.end());
    result.margins.push_back({.margin = m});
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const bool upper : {false, true}) {
      if (!((upper ? 1 - u[i] : u[i]) <= kNearBound)) continue;
      columns.emplace_back(n, 0.0);
      columns.back()[i] = upper ? -1 : 1;
      result.bounds.push_back({.variable = i, .upper = upper});
    }
  std::vector<double> left(gradient.begin(), gradient.end()), found;
  try {
    found = non_negative_least_squares(columns, left);
  } catch (const std::runtime_error&) {  // nothing is known then
    return {.optimality = std::numeric_limits<double>::quiet_NaN(), .bounds = {}, .margins = {}};
  }
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t i = 0; i < n; ++i) left[i] -= found[k] * columns[k][i];
  auto multiplier = found.begin();
  for (ActiveMargin& margin : result.margins) margin.multiplier = *multiplier++;
  for (ActiveBound& bound : result.bounds) bound.multiplier = *multiplier++;
  result.optimality = largest(left);
  return result;
}

std::optional<std::vector<double>> onto_margins(const std::vector<double>& point, std::span<const double> margins,
                                                std::span<const double> margin_gradient, double near) {
  constexpr double kHair = 1e-14;  // what a margin keeps for the rounding of its own formula
  const std::size_t n = point.size();
  std::vector<std::size_t> free, active;
  for (std::size_t i = 0; i < n; ++i)
    if (point[i] > 0 && point[i] < 1) free.push_back(i);
  for (std::size_t m = 0; m < margins.size(); ++m)
    if (std::fabs(margins[m]) <= near * largest(margin_gradient.subspan(m * n, n))) active.push_back(m);
  if (active.empty() || free.empty()) return std::nullopt;
  Eigen::MatrixXd jacobian(active.size(), free.size());
  Eigen::VectorXd missing(active.size());
  for (Eigen::Index r = 0; r < jacobian.rows(); ++r) {
    const std::size_t m = active[static_cast<std::size_t>(r)];
    missing(r) = kHair - margins[m];
    for (Eigen::Index c = 0; c < jacobian.cols(); ++c)
      jacobian(r, c) = margin_gradient[m * n + free[static_cast<std::size_t>(c)]];
  }
  const Eigen::VectorXd step = jacobian.completeOrthogonalDecomposition().solve(missing);
  std::vector<double> moved = point;
  for (Eigen::Index c = 0; c < step.size(); ++c) moved[free[static_cast<std::size_t>(c)]] += step(c);
  return moved;
}

Optimality optimality(const Problem& problem, std::span<const double> design, std::span<const double> slopes,
                      double size) {
  const DesignSpace& space = problem.space();
  const std::size_t n = space.dimension(), width = 1 + n, objectives = problem.objectives().size();
  const double sign = problem.objectives()[0].direction == Direction::maximise ? -1 : 1;
  const auto range = [&](std::size_t i) { return space[i].upper - space[i].lower; };
  std::vector<double> u, gradient, margins, margin_gradient;
  for (std::size_t i = 0; i < n; ++i) {
    u.push_back(space.to_unit(i, design[i]));
    gradient.push_back(sign * slopes[1 + i] * range(i));
  }
  for (std::size_t m = 0; m < problem.margins().size(); ++m) {
    const double* slope = &slopes[(objectives + m) * width];
    margins.push_back(slope[0]);
    for (std::size_t i = 0; i < n; ++i) margin_gradient.push_back(slope[1 + i] * range(i));
  }
  Optimality result = first_order(u, gradient, margins, margin_gradient);
  for (ActiveBound& bound : result.bounds) bound.multiplier /= range(bound.variable);
  size = std::max(size, std::fabs(slopes[0]));
  if (size > 0) result.optimality /= size;
  return result;
}

}  // namespace pkm
