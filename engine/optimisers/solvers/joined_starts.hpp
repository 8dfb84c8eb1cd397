// The table of a solver stage, which its starts join in their order: what a start comes to waits until those before it
// have ended.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/optimisers/front_keeper.hpp"
#include "engine/optimisers/solvers/start_run.hpp"

namespace pkm {

class JoinedStarts {
 public:
  /// @param table  of the stage; empty
  JoinedStarts(const SolverPlan& plan, const StageInput& input, EvaluationTable& table);

  const Scalarisation& how() const { return how_; }
  bool has_front() const { return front_.has_value(); }
  std::vector<StartRun>& starts() { return starts_; }
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }
  /// One thread at a time changes what is known of starts, and joins them.
  std::mutex& mutex() { return mutex_; }

  /// Adds to the table what is known next, and reports it. False: the monitor wants to stop. Ranks after the first do
  /// so at the stage's end.
  bool join();
  /// What another rank knows of a start.
  void know(StartAhead&& of);
  StartAhead known_of(std::size_t start) const;
  StageResult result() const;

 private:
  /// One row of the start that is joining. False: the monitor wants to stop.
  bool report(const EvaluationTable& start, std::size_t source);
  void end(StartRun& start);
  /// Evaluations that are still to be made, at most; counted now and then.
  std::int64_t left();
  /// What is known beyond the table.
  std::vector<StartAhead> ahead() const;
  /// Why the starts ended, if all did so for the same reason.
  StopReason reason() const;

  const StageInput& input_;
  std::int64_t limit_;  ///< evaluations of a start
  EvaluationTable& table_;
  Scalarisation how_;
  std::vector<StartRun> starts_;
  std::mutex mutex_;
  std::size_t next_ = 0;    ///< the start that is joining
  std::size_t joined_ = 0;  ///< its rows that have
  std::atomic<bool> stopped_ = false;
  std::optional<Goal> goal_;  ///< of the start that is joining
  Ranked best_, best_of_start_;
  std::int64_t left_ = 0;
  std::size_t counts_at_ = 0;  ///< rows of the table at which they are counted next
  std::vector<StartOutcome> finished_;
  std::vector<std::int64_t> population_;  ///< the best of the start that is joining
  std::optional<FrontKeeper> front_;      ///< several objectives: of the ends
};

}  // namespace pkm
