#include "engine/runner/optimality_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "engine/math/rounding.hpp"
#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {
namespace {

/// @return magnitude of the objective at the start design of the multistart run to which a row belongs; 0 if it belongs
/// to none
double objective_scale(const StageRecord& stage, std::int64_t row) {
  for (const StartOutcome& start : stage.starts)
    if (row >= start.first_row && row < start.first_row + start.rows)
      return std::fabs(stage.table.objective_row(static_cast<std::size_t>(start.first_row))[0]);
  return 0;
}

/// Sensitivities of the objective f with respect to every parameter p. The re-optimised sensitivity is the derivative
/// of the optimal value. By the envelope theorem it equals that of the Lagrangian: d f / d p + sum over the active
/// constraints of +- lambda_i d g_i / d p, with + if f is maximised.
std::vector<SensitivityRecord> sensitivities(const DesignProblem& problem, std::span<const double> design,
                                             const Optimality& found) {
  const ProblemParts& parts = problem.parts();
  const std::size_t count = parts.parameters.size(), width = 1 + count;
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> derivatives = problem.derivatives(problem.parameters(design), all);
  const double sign = problem.objectives()[0].direction == Direction::maximise ? 1 : -1;
  const auto& parameters = parts.mechanism->info().parameters;
  std::vector<SensitivityRecord> records;
  for (std::size_t p = 0; p < count; ++p) {
    // total: derivative with respect to parameter p; scale: largest magnitude of a derivative with respect to a
    // parameter of the same unit
    double total = derivatives[1 + p], scale = 0;
    for (std::size_t other = 0; other < count; ++other)
      if (parameters[other].unit == parameters[p].unit) scale = std::fmax(scale, std::fabs(derivatives[1 + other]));
    double max_term = scale;
    for (const ActiveConstraint& m : found.margins) {
      const double term = sign * m.multiplier * derivatives[(problem.objectives().size() + m.margin) * width + 1 + p];
      total += term;
      max_term = std::fmax(max_term, std::fabs(term));
    }
    const bool varies = std::ranges::find(parts.varies, p) != parts.varies.end();
    records.push_back({parameters[p].name, parameters[p].unit, zero_if_rounding_error(derivatives[1 + p], scale),
                       varies ? std::numeric_limits<double>::quiet_NaN() : zero_if_rounding_error(total, max_term)});
  }
  return records;
}

}  // namespace

std::optional<OptimalityRecord> optimality_record(const Study& study, const StageRecord& stage) {
  const DesignProblem& problem = *study.problem;
  const auto row = static_cast<std::size_t>(stage.best_row);
  if (problem.objectives().size() != 1 || stage.best_row < 0 || stage.table.status[row] == Status::failed)
    return std::nullopt;
  const auto design = stage.table.design(row);
  const Optimality found =
      optimality(problem, design, stage.table.derivative_row(row), objective_scale(stage, stage.best_row));
  OptimalityRecord record;
  record.optimality = found.optimality;
  for (const ActiveConstraint& m : found.margins) {
    const MarginInfo& info = problem.margins()[m.margin];
    record.active.push_back({info.name, "constraint", m.multiplier, info.unit});
  }
  for (const ActiveBound& b : found.bounds) {
    const Variable& v = problem.parts().space[b.variable];
    record.active.push_back({v.name, b.upper ? "upper bound" : "lower bound", b.multiplier, v.unit});
  }
  record.sensitivities = sensitivities(problem, design, found);
  return record;
}

}  // namespace pkm
