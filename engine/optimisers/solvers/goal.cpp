#include "engine/optimisers/solvers/goal.hpp"

#include <algorithm>
#include <limits>

namespace pkm {
namespace {

constexpr double kRho = 1e-4;

using Kind = Scalarisation::Kind;

}  // namespace

Goal::Goal(const Scalarisation& scalarisation, const Problem& problem, const EvaluationTable& table, std::size_t start)
    : how_(scalarisation), problem_(problem), table_(table), start_(start) {
  for (std::size_t k = 0; k < objectives(); ++k) from_.push_back(smooth(start, k));
  const double value = from_[how_.objective];
  const bool usable = table.status[start] != Status::failed && std::isfinite(value);
  keeps_ = table.status[start] == Status::feasible;
  scale_ = 1 / (usable && value != 0 ? std::fabs(value) : 1.0);
}

std::size_t Goal::margins() const {
  const std::size_t own = problem_.margins().size();
  if (how_.kind == Kind::achievement) return own + objectives();
  return how_.kind == Kind::epsilon && keeps_ ? own + objectives() - 1 : own;
}

double Goal::smooth(std::size_t row, std::size_t k) const {
  const bool slopes = table_.shape().detail == Detail::derivatives;
  return sign(k) *
         (slopes ? table_.slope_row(row)[k * (1 + problem_.space().dimension())] : table_.objective_row(row)[k]);
}

void Goal::add_gradient(std::size_t row, std::size_t k, double factor, std::span<double> gradient) const {
  const DesignSpace& space = problem_.space();
  const auto slope = table_.slope_row(row).subspan(k * (1 + space.dimension()) + 1);
  for (std::size_t i = 0; i < space.dimension(); ++i)
    gradient[i] += slope[i] * (space[i].upper - space[i].lower) * (sign(k) * factor);
}

void Goal::read(std::size_t row, double slack, GoalPoint& point) const {
  const DesignSpace& space = problem_.space();
  const bool slopes = table_.shape().detail == Detail::derivatives;
  const std::size_t n = dimension(), variables = space.dimension(), own = problem_.margins().size(),
                    width = 1 + variables;
  point.usable = table_.status[row] != Status::failed;
  for (std::size_t k = 0; k < objectives(); ++k) point.usable = point.usable && std::isfinite(smooth(row, k));
  point.margins.assign(margins(), -1);
  point.gradient.assign(slopes ? n : 0, 0);
  point.margin_gradient.assign(slopes ? margins() * n : 0, 0);
  if (!point.usable) return;

  const auto slope = table_.slope_row(row);
  for (std::size_t m = 0; m < own; ++m) {
    const std::size_t at = (objectives() + m) * width;
    point.margins[m] = slopes ? slope[at] : table_.margin_row(row)[m];
    for (std::size_t i = 0; slopes && i < variables; ++i)
      point.margin_gradient[m * n + i] = slope[at + 1 + i] * (space[i].upper - space[i].lower);
  }
  const std::size_t j = how_.objective;
  if (how_.kind == Kind::achievement) {
    point.objective = t_of(slack);
    if (slopes) point.gradient[n - 1] = most_t() - least_t();
    for (std::size_t k = 0; k < objectives(); ++k) point.objective += kRho * gain(row, k);
    for (std::size_t k = 0; slopes && k < objectives(); ++k)
      add_gradient(row, k, kRho / how_.extents[k], point.gradient);
  } else {
    point.objective = smooth(row, j) * scale_;
    if (slopes) add_gradient(row, j, scale_, point.gradient);
  }
  if (margins() == own) return;
  std::size_t m = own;
  for (std::size_t k = 0; k < objectives(); ++k) {
    if (how_.kind == Kind::epsilon && k == j) continue;
    point.margins[m] = (has_slack() ? t_of(slack) : 0) - gain(row, k);
    if (slopes) {
      const std::span gradient(&point.margin_gradient[m * n], n);
      add_gradient(row, k, -1 / how_.extents[k], gradient);
      if (has_slack()) gradient[n - 1] = most_t() - least_t();
    }
    ++m;
  }
}

double Goal::slack(std::size_t row) const {
  if (!has_slack()) return 0;
  double t = least_t();
  for (std::size_t k = 0; k < objectives(); ++k) t = std::max(t, gain(row, k));
  return std::isfinite(t) ? std::min((t - least_t()) / (most_t() - least_t()), 1.0) : 1;
}

double Goal::value(std::size_t row) const {
  if (how_.kind != Kind::achievement) return stored(row, how_.objective);
  double greatest = -std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t k = 0; k < objectives(); ++k) {
    const double g = (stored(row, k) - stored(start_, k)) / how_.extents[k];
    greatest = std::max(greatest, g);
    sum += g;
  }
  return greatest + kRho * sum;
}

double Goal::violation(std::size_t row) const {
  double sum = pkm::violation(table_.margin_row(row));
  if (how_.kind == Kind::none || !keeps_) return sum;
  for (std::size_t k = 0; k < objectives(); ++k)
    if (stored(row, k) > stored(start_, k)) sum += (stored(row, k) - stored(start_, k)) / how_.extents[k];
  return sum;
}

Ranked Goal::rank(std::size_t row) const {
  Ranked r{table_.status[row], 0, static_cast<std::int64_t>(row)};
  if (r.status == Status::failed) return r;
  const double broken = violation(row);
  // An end that gives up an objective is no better than an infeasible one.
  if (r.status == Status::feasible && broken > 0) r.status = Status::infeasible;
  r.value = r.status == Status::feasible ? value(row) : broken;
  return r;
}

}  // namespace pkm
