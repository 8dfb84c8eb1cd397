// One run of a study: executes the stages in sequence, writes checkpoints and computes the final results.
//
// Resuming is deterministic replay: every stage restarts its optimiser from the beginning, and evaluations recorded in
// the study file are returned (ReplayEvaluator) before new ones are computed.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/core/ranks.hpp"
#include "engine/runner/progress.hpp"
#include "engine/runner/run_outcome.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/runner/study_output.hpp"
#include "engine/runner/timed_evaluator.hpp"
#include "engine/storage/checkpoint_clock.hpp"

namespace pkm {

class Run final : public Monitor {
 public:
  /// @param contents  contents of the study file so far, which the run replays and continues
  /// @param output    output file on MPI rank 0; null on worker ranks, which write nothing
  Run(const Study& study, StudyContents contents, StudyOutput* output, const RunOptions& options, Progress& progress);

  /// Writes the file of a new study, before its first evaluation.
  void begin();
  /// Runs the stages with one team of threads. Collective: all MPI ranks must call it. Throws StorageError,
  /// UnwrittenOutcome and ReplayMismatch.
  RunOutcome operator()();

  // Functions of Monitor, which the optimisers call:
  bool generation(const Generation& generation) override;
  bool goes_on() override;
  void warn(const std::string& sentence) override;

 private:
  void run_stages();
  /// Runs one stage.
  /// @return false if the run has to stop
  bool run_stage(std::size_t index);
  StageInput stage_input(std::size_t index);
  /// Makes a row of the current stage the best evaluation of the study, if it is better than that of the earlier
  /// stages.
  void update_best(const EvaluationTable& table, std::int64_t row);

  /// MPI rank 0 only: reports progress, checks for stop requests and writes a checkpoint if one is due.
  void process_generation(const Generation& generation);
  /// Sends MPI rank 0's decision whether to stop to all ranks, and verifies that all ranks have the same evaluations.
  void synchronise_ranks(const Generation& generation);
  ProgressReport progress_report(const Generation& generation);

  /// MPI rank 0 only: computes the final results unless the run is stopped, writes the file and returns the outcome.
  RunOutcome complete();
  /// @return an outcome that contains only the statistics on evaluations, parallel efficiency and messages
  RunOutcome statistics() const;
  /// Computes the final results of the study, and stores them in its contents.
  void compute_final_results();
  /// @return true if the run has to stop: after a signal, when the time limit is reached, or if the caller requests it.
  /// Thread-safe.
  bool has_stop_request() const;
  int signal_received() const { return options_.handles_signals ? StopRequest::signal() : 0; }
  bool is_time_over() const { return options_.time_limit && seconds() >= *options_.time_limit; }
  /// @return true if a stop was requested so long ago that evaluations in progress must be aborted. When the run is
  /// resumed, they are repeated.
  bool is_grace_period_over();
  void write(StudyState state);
  /// Handles std::bad_alloc: releases memory, writes the complete generations as a checkpoint and throws StorageError.
  [[noreturn]] void save_after_out_of_memory();

  double seconds() const { return steady_seconds() - start_; }

  const Study& study_;
  StudyOutput* output_;
  RunOptions options_;
  Progress& progress_;
  CheckpointClock clock_;
  TimedEvaluator evaluator_;
  StudyContents contents_;
  std::vector<StageRecord> recorded_;  ///< stages read from the study file, whose evaluations are replayed
  double earlier_seconds_;             ///< total wall time of the previous runs of this study [s]
  double start_ = steady_seconds();
  std::size_t stage_ = 0;   ///< index of the current stage
  std::int64_t limit_ = 0;  ///< maximum number of evaluations of the current stage
  std::int64_t made_ = 0;   ///< number of new evaluations in this run up to the last generation
  /// Function that returns a solver stage's multistart runs that are not yet merged; empty in other stages.
  std::function<std::vector<UnmergedRun>()> ahead_;
  bool replaying_;  ///< true as long as all evaluations of this run were recorded by earlier runs
  /// Number of rows that belong to complete generations of the stage; std::nullopt while a generation is being
  /// recorded.
  std::optional<std::size_t> complete_rows_;
  std::string stopped_;         ///< reason for stopping the run; "": the run continues
  std::exception_ptr failure_;  ///< on MPI rank 0, the exception that ends the run on all ranks
  bool failed_ = false;         ///< on every MPI rank, true if an exception on rank 0 ends the run
  /// Time of the first stop request, counted from the start of this run [s].
  std::atomic<double> stop_requested_at_ = std::numeric_limits<double>::infinity();
  std::optional<RemainingTime> remaining_;  ///< estimate of the remaining time; set on MPI rank 0 only
  int threads_ = 0;                         ///< number of threads of all MPI ranks together
  /// Time spent in messages between MPI ranks before this run [s].
  double initial_exchange_ = ranks::communication_seconds();
  std::vector<std::string> warnings_;
};

}  // namespace pkm
