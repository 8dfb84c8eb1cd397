#include "engine/optimisers/solvers/multistart_run.hpp"

#include <utility>

#include "engine/optimisers/sampling.hpp"

namespace pkm {
namespace {

/// Restores the multistart runs that were recorded before the stage was interrupted. A finished run is not repeated,
/// unless it ended by an evaluation limit that has been raised since then.
void read_record(const SolverPlan& plan, const StageInput& input, std::vector<MultistartRun>& starts) {
  const auto restore = [&](std::size_t k, EvaluationTable table, const StartOutcome* outcome) {
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
    restore(k, record.slice(next, end), &outcome);
    next = end;
  }
  restore(input.recorded_starts.size(), record.slice(next, record.size()), nullptr);
  for (const UnmergedRun& ahead : input.recorded_unmerged_runs)
    restore(static_cast<std::size_t>(ahead.number), ahead.table, ahead.outcome ? &*ahead.outcome : nullptr);
}

}  // namespace

std::vector<MultistartRun> make_multistart_runs(const SolverPlan& plan, const StageInput& input) {
  const DesignSpace& space = input.problem.space();
  const EvaluationShape shape = input.problem.shape(plan.detail);
  std::vector<MultistartRun> starts;
  const auto add = [&](StartDesign start) {
    starts.push_back({std::move(start), EvaluationTable(shape), EvaluationTable(shape)});
  };
  for (const StartDesign& start : input.starts) add(start);
  const auto count = static_cast<std::size_t>(plan.multistart);
  const auto units = unit_cube_samples(Start::sobol, count, space.dimension(), input.seed);
  for (std::size_t k = 0; k < count; ++k) {
    StartDesign start{{}, "Sobol point " + std::to_string(k + 1)};
    for (std::size_t i = 0; i < space.dimension(); ++i)
      start.design.push_back(space.from_unit(i, units[k * space.dimension() + i]));
    add(std::move(start));
  }
  if (input.recorded) read_record(plan, input, starts);
  return starts;
}

}  // namespace pkm
