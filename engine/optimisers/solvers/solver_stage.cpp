#include "engine/optimisers/solvers/solver_stage.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/optimisers/solvers/multistart_merger.hpp"
#include "engine/optimisers/solvers/solve_from_start.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/row_exchange.hpp"

namespace pkm {
namespace {

/// One run of a solver stage, on this MPI rank.
class SolverStageRun {
 public:
  SolverStageRun(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
      : plan_(plan), input_(input), table_(table), merger_(plan, input, table) {}

  StageResult operator()() {
    const std::vector<MultistartRun>& starts = merger_.starts();
    std::vector<std::size_t> unfinished;
    for (std::size_t k = 0; k < starts.size(); ++k)
      if (!starts[k].ended) unfinished.push_back(k);
    // Merges the multistart runs that had finished before a stage was resumed.
    if (unfinished.size() < starts.size() && is_rank_0()) merger_.merge();
    {
      ranks::Counter claims, stops;
      stops_ = &stops;
      const auto work = [&] {
        for (auto k = claims.next(); k < std::ssize(unfinished) && !merger_.stopped(); k = claims.next())
          run_start(unfinished[static_cast<std::size_t>(k)]);
      };
      parallel_for_nested(plan_.concurrent ? std::min(workers(), unfinished.size()) : 1, work);
    }
    if (ranks::size() > 1) synchronise_ranks();
    return merger_.result();
  }

 private:
  static bool is_rank_0() { return ranks::rank() == 0; }

  /// Executes multistart run number `k` on this thread.
  void run_start(std::size_t k) {
    if (merger_.stopped()) return;
    MultistartRun& run = merger_.starts()[k];
    run.is_local = true;
    try {
      try {
        ReplayEvaluator replay(input_.evaluator, run.recorded);
        solve(k, run, replay);
      } catch (const ReplayMismatch&) {
        const std::lock_guard guard(merger_.mutex());
        run.warning = "Start " + std::to_string(k + 1) + " (" + run.start.origin +
                      ") deviated from its recorded evaluations, as can happen on another processor; it was restarted.";
        run.table = run.recorded = EvaluationTable(run.table.shape());
      }
      if (!run.warning.empty()) solve(k, run, input_.evaluator);
    } catch (const Stopped&) {  // thrown during an evaluation, which is repeated when the study is resumed
      merger_.stop();
    } catch (...) {
      merger_.stop();  // stops the runs of the other starts, too
      throw;
    }
  }

  void solve(std::size_t k, MultistartRun& run, Evaluator& evaluator) {
    // `table` belongs to this thread; run.table is a copy that other threads read under the mutex.
    EvaluationTable table(run.table.shape());
    const auto evaluated = [&] {
      const std::lock_guard guard(merger_.mutex());
      run.table.append(table, table.size() - 1);
      return merge_and_check_stop();
    };
    NonlinearProgram program({input_.problem, evaluator, table, merger_.scalarisation(), evaluated}, plan_.limits,
                             run.start.design);
    const bool start_evaluated = !merger_.has_front() || table.status[0] != Status::failed;
    std::optional<StartOutcome> outcome =
        solve_from_start(*plan_.solver, program, table, input_.seed + k, start_evaluated);
    if (!outcome) return;
    outcome->origin = run.start.origin;
    const std::lock_guard guard(merger_.mutex());
    run.outcome = std::move(*outcome);
    run.ended = true;
    if (!is_rank_0()) {
      std::string message(reinterpret_cast<const char*>(&input_.seed), sizeof input_.seed);
      pack_unmerged_run(merger_.snapshot(k), message);
      ranks::post(message);
    }
    merge_and_check_stop();
  }

  /// Called after each evaluation. On MPI rank 0, appends all rows that can be appended in start order to the
  /// evaluation table of the stage. The caller must have locked the mutex.
  /// @return false if the stage has to stop
  bool merge_and_check_stop() {
    if (ranks::size() > 1) {
      if (!is_rank_0()) {
        // Only MPI rank 0 decides when to stop; other ranks query its decision, not too often, because each query costs
        // a message.
        const auto now = std::chrono::steady_clock::now();
        if (now - last_stop_query_ < std::chrono::milliseconds(100)) return !merger_.stopped();
        last_stop_query_ = now;
        if (stops_->next(0) > 0) merger_.stop();
        return !merger_.stopped();
      }
      while (const auto message = ranks::poll()) {
        // Seed of the stage to which the message belongs: a message may arrive after the end of its stage.
        std::uint64_t stage = 0;
        std::memcpy(&stage, message->data(), sizeof stage);
        if (stage == input_.seed) receive(*message, sizeof stage);
      }
    }
    if (!merger_.merge()) stops_->next();
    return !merger_.stopped();
  }

  /// Exchanges the results of all MPI ranks, and whether the stage was stopped. A collective operation: all ranks must
  /// call it.
  void synchronise_ranks() {
    std::string mine;
    for (std::size_t k = 0; k < merger_.starts().size(); ++k)
      if (merger_.starts()[k].is_local) pack_unmerged_run(merger_.snapshot(k), mine);
    for (const std::string& bytes : ranks::all_gather(mine)) receive(bytes, 0);
    if (is_rank_0()) merger_.merge();
    std::string state(1, merger_.stopped() ? kStopped : kDone);
    if (is_rank_0()) state += std::to_string(hash_of_rows(table_, 0, table_.size()));
    ranks::broadcast(state);
    if (state.front() == kStopped) return merger_.stop();
    if (is_rank_0()) return;
    merger_.merge();
    if (state.substr(1) != std::to_string(hash_of_rows(table_, 0, table_.size())))
      ranks::abort_all_ranks("the results of the solver differ from those on rank 0 (" + ranks::host(0) +
                             "); every host must run the same program with the same libraries");
  }

  void receive(const std::string& bytes, std::size_t at) {
    while (at < bytes.size()) merger_.receive(unpack_unmerged_run(bytes, at, table_.shape()));
  }

  static constexpr char kStopped = 's', kDone = 'd';

  const SolverPlan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  MultistartMerger merger_;
  ranks::Counter* stops_ = nullptr;  ///< shared by all MPI ranks; a count above 0: rank 0 has stopped the stage
  std::chrono::steady_clock::time_point last_stop_query_ = std::chrono::steady_clock::now();
};

class SolverStage final : public Optimiser {
 public:
  explicit SolverStage(SolverPlan plan) : plan_(std::move(plan)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    return SolverStageRun(plan_, input, table)();
  }
  std::int64_t evaluation_limit(const Problem&) const override {
    return (plan_.starts + plan_.multistart) * plan_.limits.evaluations;
  }
  std::int64_t at_once() const override { return plan_.concurrent ? plan_.starts + plan_.multistart : 1; }
  Detail detail() const override { return plan_.detail; }

 private:
  SolverPlan plan_;
};

}  // namespace

std::unique_ptr<Optimiser> make_solver_stage(SolverPlan plan) { return std::make_unique<SolverStage>(std::move(plan)); }

}  // namespace pkm
