#include "engine/optimisers/solvers/scalarised_problem.hpp"

#include <algorithm>
#include <limits>

namespace pkm {
namespace {

constexpr double kAugmentation = 1e-4;  // weight rho of the augmentation term in the achievement function

using Kind = Scalarisation::Kind;

}  // namespace

ScalarisedProblem::ScalarisedProblem(const Scalarisation& scalarisation, const Problem& problem,
                                     const EvaluationTable& table, std::size_t start)
    : scalarisation_(scalarisation), problem_(problem), table_(table), start_(start) {
  for (std::size_t k = 0; k < objectives(); ++k) start_values_.push_back(smooth_value(start, k));
  const double value = start_values_[scalarisation_.objective];
  const bool usable = table.status[start] != Status::failed && std::isfinite(value);
  start_is_feasible_ = table.status[start] == Status::feasible;
  scale_ = 1 / (usable && value != 0 ? std::fabs(value) : 1.0);
}

std::size_t ScalarisedProblem::constraints() const {
  const std::size_t own = problem_.margins().size();
  if (scalarisation_.kind == Kind::achievement) return own + objectives();
  return scalarisation_.kind == Kind::epsilon && start_is_feasible_ ? own + objectives() - 1 : own;
}

double ScalarisedProblem::smooth_value(std::size_t row, std::size_t k) const {
  const bool has_derivatives = table_.shape().detail == Detail::derivatives;
  return sign(k) * (has_derivatives ? table_.derivative_row(row)[k * (1 + problem_.space().dimension())]
                                    : table_.objective_row(row)[k]);
}

void ScalarisedProblem::add_gradient(std::size_t row, std::size_t k, double factor, std::span<double> gradient) const {
  const DesignSpace& space = problem_.space();
  const auto derivatives = table_.derivative_row(row).subspan(k * (1 + space.dimension()) + 1);
  for (std::size_t i = 0; i < space.dimension(); ++i)
    gradient[i] += derivatives[i] * (space[i].upper - space[i].lower) * (sign(k) * factor);
}

void ScalarisedProblem::read(std::size_t row, double epigraph, NlpPoint& point) const {
  const DesignSpace& space = problem_.space();
  const bool has_derivatives = table_.shape().detail == Detail::derivatives;
  const std::size_t n = dimension(), variables = space.dimension(), own = problem_.margins().size(),
                    width = 1 + variables;
  point.usable = table_.status[row] != Status::failed;
  for (std::size_t k = 0; k < objectives(); ++k) point.usable = point.usable && std::isfinite(smooth_value(row, k));
  point.margins.assign(constraints(), -1);
  point.gradient.assign(has_derivatives ? n : 0, 0);
  point.margin_jacobian.assign(has_derivatives ? constraints() * n : 0, 0);
  if (!point.usable) return;

  const auto derivatives = table_.derivative_row(row);
  for (std::size_t m = 0; m < own; ++m) {
    const std::size_t at = (objectives() + m) * width;
    point.margins[m] = has_derivatives ? derivatives[at] : table_.margin_row(row)[m];
    for (std::size_t i = 0; has_derivatives && i < variables; ++i)
      point.margin_jacobian[m * n + i] = derivatives[at + 1 + i] * (space[i].upper - space[i].lower);
  }
  const std::size_t j = scalarisation_.objective;
  if (scalarisation_.kind == Kind::achievement) {
    point.objective = t_from_unit(epigraph);
    if (has_derivatives) point.gradient[n - 1] = t_max() - t_min();
    for (std::size_t k = 0; k < objectives(); ++k) point.objective += kAugmentation * scaled_change(row, k);
    for (std::size_t k = 0; has_derivatives && k < objectives(); ++k)
      add_gradient(row, k, kAugmentation / scalarisation_.extents[k], point.gradient);
  } else {
    point.objective = smooth_value(row, j) * scale_;
    if (has_derivatives) add_gradient(row, j, scale_, point.gradient);
  }
  if (constraints() == own) return;
  std::size_t m = own;
  for (std::size_t k = 0; k < objectives(); ++k) {
    if (scalarisation_.kind == Kind::epsilon && k == j) continue;
    point.margins[m] = (has_epigraph() ? t_from_unit(epigraph) : 0) - scaled_change(row, k);
    if (has_derivatives) {
      const std::span gradient(&point.margin_jacobian[m * n], n);
      add_gradient(row, k, -1 / scalarisation_.extents[k], gradient);
      if (has_epigraph()) gradient[n - 1] = t_max() - t_min();
    }
    ++m;
  }
}

double ScalarisedProblem::epigraph(std::size_t row) const {
  if (!has_epigraph()) return 0;
  double t = t_min();
  for (std::size_t k = 0; k < objectives(); ++k) t = std::max(t, scaled_change(row, k));
  return std::isfinite(t) ? std::min((t - t_min()) / (t_max() - t_min()), 1.0) : 1;
}

double ScalarisedProblem::value(std::size_t row) const {
  if (scalarisation_.kind != Kind::achievement) return stored_value(row, scalarisation_.objective);
  double maximum = -std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t k = 0; k < objectives(); ++k) {
    const double g = (stored_value(row, k) - stored_value(start_, k)) / scalarisation_.extents[k];
    maximum = std::max(maximum, g);
    sum += g;
  }
  return maximum + kAugmentation * sum;
}

double ScalarisedProblem::violation(std::size_t row) const {
  double sum = pkm::violation(table_.margin_row(row));
  if (scalarisation_.kind == Kind::none || !start_is_feasible_) return sum;
  for (std::size_t k = 0; k < objectives(); ++k)
    if (stored_value(row, k) > stored_value(start_, k))
      sum += (stored_value(row, k) - stored_value(start_, k)) / scalarisation_.extents[k];
  return sum;
}

RankKey ScalarisedProblem::rank(std::size_t row) const {
  RankKey r{table_.status[row], 0, static_cast<std::int64_t>(row)};
  if (r.status == Status::failed) return r;
  const double total = violation(row);
  // The result of a multistart run must not be worse than the start design in any objective; otherwise it ranks as
  // infeasible.
  if (r.status == Status::feasible && total > 0) r.status = Status::infeasible;
  r.value = r.status == Status::feasible ? value(row) : total;
  return r;
}

}  // namespace pkm
