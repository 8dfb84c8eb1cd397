// Merges the evaluations of concurrent multistart runs into the evaluation table of the stage in start order, so that
// results do not depend on timing. The evaluations of a run are buffered until all earlier runs have finished and been
// merged.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/optimisers/pareto_archive.hpp"
#include "engine/optimisers/solvers/multistart_run.hpp"

namespace pkm {

class MultistartMerger {
 public:
  /// @param table  the evaluation table of the stage, which must be empty and receives the merged evaluations
  MultistartMerger(const SolverPlan& plan, const StageInput& input, EvaluationTable& table);

  const Scalarisation& scalarisation() const { return scalarisation_; }
  bool has_front() const { return archive_.has_value(); }
  std::vector<MultistartRun>& starts() { return starts_; }
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }
  /// The mutex that must be locked during access to starts() and calls of merge().
  std::mutex& mutex() { return mutex_; }

  /// Appends to the evaluation table of the stage all rows that can be appended in start order, and reports each to the
  /// monitor. MPI rank 0 merges during the stage, the other ranks at its end.
  /// @return false if the stage was stopped, for example by the monitor
  bool merge();
  /// Stores what another MPI rank has sent about a multistart run: its evaluations and, if the run has finished, its
  /// outcome.
  void receive(UnmergedRun&& remote);
  /// Copy of the evaluations of multistart run `k` and, if it has finished, of its outcome.
  UnmergedRun snapshot(std::size_t k) const;
  StageResult result() const;

 private:
  /// Appends row `source` of the multistart run being merged to the evaluation table of the stage, and reports it to
  /// the monitor.
  /// @return false if the monitor requests a stop
  bool append_and_report(const EvaluationTable& run_table, std::size_t source);
  /// Records the outcome of a multistart run after all of its rows have been merged, and proceeds to the next run.
  void finish(MultistartRun& run);
  /// Maximum number of evaluations that all multistart runs together can still make. The number is cached, and computed
  /// again only after a number of rows equal to a sixteenth of the number of runs has been merged.
  std::int64_t evaluations_left();
  /// Snapshots of those multistart runs that have evaluations not yet contained in the evaluation table of the stage.
  std::vector<UnmergedRun> unmerged_runs() const;
  /// The stop reason of the multistart runs if it is the same for all of them, otherwise StopReason::starts.
  StopReason common_stop_reason() const;

  const StageInput& input_;
  std::int64_t max_evaluations_;  ///< maximum number of evaluations of one multistart run
  EvaluationTable& table_;
  Scalarisation scalarisation_;
  std::vector<MultistartRun> starts_;
  std::mutex mutex_;
  std::size_t next_ = 0;         ///< index of the multistart run whose rows are being merged
  std::size_t merged_rows_ = 0;  ///< number of rows of this run that are already in the stage table
  std::atomic<bool> stopped_ = false;
  std::optional<ScalarisedProblem> scalarised_;  ///< scalarised problem of the run whose rows are being merged
  RankKey best_, best_of_start_;
  std::int64_t evaluations_left_ = 0;
  std::size_t next_count_size_ = 0;  ///< number of rows of the stage table at which evaluations_left_ is computed again
  std::vector<StartOutcome> finished_;
  std::vector<std::int64_t> population_;  ///< the best row of the run whose rows are being merged
  std::optional<ParetoArchive> archive_;  ///< non-dominated results of the runs; std::nullopt with one objective
};

}  // namespace pkm
