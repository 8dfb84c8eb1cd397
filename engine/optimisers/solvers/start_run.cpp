#include "engine/optimisers/solvers/start_run.hpp"

#include <utility>

#include "engine/optimisers/start.hpp"

namespace pkm {
namespace {

/// Starts that had ended are taken as they are, but for those that ended by a limit that has been raised since.
void read_record(const SolverPlan& plan, const StageInput& input, std::vector<StartRun>& starts) {
  const auto know = [&](std::size_t k, EvaluationTable table, const StartOutcome* outcome) {
    if (k >= starts.size() || table.size() < starts[k].recorded.size()) return;
    starts[k].recorded = std::move(table);
    if (!outcome || (outcome->stop == words(StopReason::evaluations) && outcome->rows < plan.limits.evaluations))
      return;
    starts[k].ended = true;
    starts[k].outcome = *outcome;
    starts[k].table = std::move(starts[k].recorded);
  };
  const EvaluationTable& record = *input.recorded;
  std::size_t next = 0;
  for (std::size_t k = 0; k < input.recorded_starts.size(); ++k) {
    StartOutcome outcome = input.recorded_starts[k];
    outcome.end_row -= std::exchange(outcome.first_row, 0);
    const std::size_t end = next + static_cast<std::size_t>(outcome.rows);
    know(k, record.slice(next, end), &outcome);
    next = end;
  }
  know(input.recorded_starts.size(), record.slice(next, record.size()), nullptr);
  for (const StartAhead& ahead : input.recorded_ahead)
    know(static_cast<std::size_t>(ahead.number), ahead.table, ahead.outcome ? &*ahead.outcome : nullptr);
}

}  // namespace

std::vector<StartRun> starts_of_stage(const SolverPlan& plan, const StageInput& input) {
  const DesignSpace& space = input.problem.space();
  const EvaluationShape shape = input.problem.shape(plan.detail);
  std::vector<StartRun> starts;
  const auto add = [&](StartDesign from) {
    starts.push_back({std::move(from), EvaluationTable(shape), EvaluationTable(shape)});
  };
  for (const StartDesign& from : input.starts) add(from);
  const auto count = static_cast<std::size_t>(plan.multistart);
  const auto units = start_points(Start::sobol, count, space.dimension(), input.seed);
  for (std::size_t k = 0; k < count; ++k) {
    StartDesign from{{}, "Sobol point " + std::to_string(k + 1)};
    for (std::size_t i = 0; i < space.dimension(); ++i)
      from.design.push_back(space.from_unit(i, units[k * space.dimension() + i]));
    add(std::move(from));
  }
  if (input.recorded) read_record(plan, input, starts);
  return starts;
}

}  // namespace pkm
