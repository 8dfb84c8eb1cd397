#include "engine/optimisers/solvers/multistart_merger.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/ranks.hpp"

namespace pkm {

MultistartMerger::MultistartMerger(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
    : input_(input),
      max_evaluations_(plan.limits.evaluations),
      table_(table),
      scalarisation_(plan.scalarisation),
      starts_(make_multistart_runs(plan, input)) {
  const auto& objectives = input.problem.objectives();
  if (objectives.size() == 1) return;
  scalarisation_.extents = input.previous_front.extents;
  ParetoArchivePlan archive;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    if (objectives[k].name == plan.objective) scalarisation_.objective = k;
    if (!input.previous_front.reference.empty())
      archive.reference[objectives[k].name] = input.previous_front.reference[k];
  }
  archive_.emplace(archive, input.problem, table);
}

bool MultistartMerger::merge() {
  while (!stopped_ && next_ < starts_.size()) {
    MultistartRun& run = starts_[next_];
    // While a run still replays recorded evaluations, its rows are not merged: the run may deviate from the record, and
    // is then restarted.
    if (!run.ended && run.table.size() <= run.recorded.size()) break;
    while (!stopped_ && merged_rows_ < run.table.size()) stopped_ = !append_and_report(run.table, merged_rows_++);
    if (stopped_ || !run.ended) break;
    finish(run);
  }
  if (!stopped_ && !input_.monitor.goes_on()) stopped_ = true;
  return !stopped_;
}

bool MultistartMerger::append_and_report(const EvaluationTable& run_table, std::size_t source) {
  const std::size_t row = table_.append(run_table, source);
  if (source == 0) {
    scalarised_.emplace(scalarisation_, input_.problem, table_, row);
    best_of_start_ = {};
  }
  const RankKey candidate = scalarised_->rank(row);
  if (best_of_start_.row < 0 || candidate < best_of_start_) best_of_start_ = candidate;
  // With several objectives, the best row of the stage is the compromise solution of its front, which finish()
  // determines.
  if (best_.row < 0 || (scalarisation_.kind == Scalarisation::Kind::none && candidate < best_)) best_ = candidate;
  population_ = {best_of_start_.row};
  return input_.monitor.generation({.number = static_cast<std::int64_t>(row),
                                    .first_row = row,
                                    .table = &table_,
                                    .population = &population_,
                                    .best_row = best_.row,
                                    .starts = &finished_,
                                    .ahead = [this] { return unmerged_runs(); },
                                    .left = evaluations_left(),
                                    .alone = true});
}

void MultistartMerger::finish(MultistartRun& run) {
  StartOutcome outcome = run.outcome;
  outcome.first_row = static_cast<std::int64_t>(table_.size() - run.table.size());
  outcome.end_row += outcome.first_row;
  if (!run.warning.empty()) input_.monitor.warn(run.warning);
  if (archive_) {  // the result of this start is added to the Pareto front of the stage
    archive_->add(std::array{outcome.end_row});
    if (archive_->compromise_row() >= 0)
      best_ = ranked(input_.problem.objectives(), table_, static_cast<std::size_t>(archive_->compromise_row()));
  }
  finished_.push_back(std::move(outcome));
  // Releases the memory of the merged rows; with several MPI ranks, the other ranks still need them.
  if (ranks::size() == 1) run.table = EvaluationTable();
  ++next_;
  merged_rows_ = 0;
}

void MultistartMerger::receive(UnmergedRun&& remote) {
  MultistartRun& run = starts_.at(static_cast<std::size_t>(remote.number));
  if (run.ended) return;
  run.ended = remote.outcome.has_value();
  if (run.ended) run.outcome = std::move(*remote.outcome);
  (run.ended ? run.table : run.recorded) = std::move(remote.table);
}

UnmergedRun MultistartMerger::snapshot(std::size_t k) const {
  const MultistartRun& run = starts_[k];
  UnmergedRun copy{static_cast<std::int64_t>(k), run.checkpoint_table(), {}};
  if (run.ended) copy.outcome = run.outcome;
  return copy;
}

std::int64_t MultistartMerger::evaluations_left() {
  if (table_.size() < next_count_size_) return evaluations_left_;
  next_count_size_ = table_.size() + starts_.size() / 16;
  evaluations_left_ = 0;
  for (std::size_t k = next_; k < starts_.size(); ++k)
    if (!starts_[k].ended) evaluations_left_ += max_evaluations_ - static_cast<std::int64_t>(starts_[k].table.size());
  return evaluations_left_;
}

std::vector<UnmergedRun> MultistartMerger::unmerged_runs() const {
  std::vector<UnmergedRun> unmerged;
  for (std::size_t k = next_; k < starts_.size(); ++k) {
    const MultistartRun& run = starts_[k];
    if (k == next_ && !run.ended && run.checkpoint_table().size() == merged_rows_) continue;
    if (run.checkpoint_table().size() > 0) unmerged.push_back(snapshot(k));
  }
  return unmerged;
}

StopReason MultistartMerger::common_stop_reason() const {
  for (const StopReason each : {StopReason::tolerance, StopReason::evaluations, StopReason::time, StopReason::failed})
    if (std::ranges::all_of(finished_, [&](const StartOutcome& o) { return o.stop == words(each); })) return each;
  return StopReason::starts;
}

StageResult MultistartMerger::result() const {
  if (stopped_) return {StopReason::interrupted, best_.row, finished_, unmerged_runs()};
  StageResult result{common_stop_reason(), best_.row, finished_};
  if (archive_) result.front = archive_->front();
  return result;
}

}  // namespace pkm
