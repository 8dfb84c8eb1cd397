#include "engine/study/optimality_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "engine/math/rounding.hpp"
#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {
namespace {

/// The size of the objective at the start that a row belongs to; 0: it belongs to none.
double size_at_start(const StageRecord& stage, std::int64_t row) {
  for (const StartOutcome& start : stage.starts)
    if (row >= start.first_row && row < start.first_row + start.rows)
      return std::fabs(stage.table.objective_row(static_cast<std::size_t>(start.first_row))[0]);
  return 0;
}

/// By every parameter: how the objective changes, and how the active margins do, which the variables then make up for.
std::vector<SensitivityRecord> sensitivities(const DesignProblem& problem, std::span<const double> design,
                                             const Optimality& found) {
  const ProblemParts& parts = problem.parts();
  const std::size_t count = parts.parameters.size(), width = 1 + count;
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> slopes = problem.slopes(problem.parameters(design), all);
  const double sign = problem.objectives()[0].direction == Direction::maximise ? 1 : -1;
  const auto& parameters = parts.mechanism->info().parameters;
  std::vector<SensitivityRecord> records;
  for (std::size_t p = 0; p < count; ++p) {
    double follow = slopes[1 + p], steepest = 0;  // of the objective, by any parameter of this unit
    for (std::size_t other = 0; other < count; ++other)
      if (parameters[other].unit == parameters[p].unit) steepest = std::fmax(steepest, std::fabs(slopes[1 + other]));
    double greatest_term = steepest;
    for (const ActiveMargin& m : found.margins) {
      const double term = sign * m.multiplier * slopes[(problem.objectives().size() + m.margin) * width + 1 + p];
      follow += term;
      greatest_term = std::fmax(greatest_term, std::fabs(term));
    }
    const bool varies = std::ranges::find(parts.varies, p) != parts.varies.end();
    records.push_back({parameters[p].name, parameters[p].unit, beyond_rounding(slopes[1 + p], steepest),
                       varies ? std::numeric_limits<double>::quiet_NaN() : beyond_rounding(follow, greatest_term)});
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
      optimality(problem, design, stage.table.slope_row(row), size_at_start(stage, stage.best_row));
  OptimalityRecord record;
  record.optimality = found.optimality;
  for (const ActiveMargin& m : found.margins) {
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
