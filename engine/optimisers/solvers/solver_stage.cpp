#include "engine/optimisers/solvers/solver_stage.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/optimisers/solvers/joined_starts.hpp"
#include "engine/optimisers/solvers/solve_start.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/row_exchange.hpp"

namespace pkm {
namespace {

/// One run of a stage.
class Run {
 public:
  Run(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
      : plan_(plan), input_(input), table_(table), stage_(plan, input, table) {}

  StageResult operator()() {
    const std::vector<StartRun>& starts = stage_.starts();
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < starts.size(); ++k)
      if (!starts[k].ended) open.push_back(k);
    if (open.size() < starts.size() && leads()) stage_.join();  // those that had ended
    {
      ranks::Counter claims, stops;
      stops_ = &stops;
      const auto work = [&] {
        for (auto k = claims.next(); k < std::ssize(open) && !stage_.stopped(); k = claims.next())
          run(open[static_cast<std::size_t>(k)]);
      };
      share_long_pieces(plan_.side_by_side ? std::min(workers(), open.size()) : 1, work);
    }
    if (ranks::size() > 1) agree();
    return stage_.result();
  }

 private:
  static bool leads() { return ranks::rank() == 0; }

  /// One start, on this thread.
  void run(std::size_t k) {
    if (stage_.stopped()) return;
    StartRun& start = stage_.starts()[k];
    start.here = true;
    try {
      try {
        ReplayEvaluator replay(input_.evaluator, start.recorded);
        solve(k, start, replay);
      } catch (const ReplayMismatch&) {
        const std::lock_guard guard(stage_.mutex());
        start.warning = "Start " + std::to_string(k + 1) + " (" + start.from.origin +
                        ") left the path on record, as solvers may on another processor; it began anew.";
        start.table = start.recorded = EvaluationTable(start.table.shape());
      }
      if (!start.warning.empty()) solve(k, start, input_.evaluator);
    } catch (const Stopped&) {  // within an evaluation, which is made again
      stage_.stop();
    } catch (...) {
      stage_.stop();  // the others need not go on
      throw;
    }
  }

  void solve(std::size_t k, StartRun& start, Evaluator& evaluator) {
    // The solver's table is its thread's; what others may read is a copy of it.
    EvaluationTable table(start.table.shape());
    const auto evaluated = [&] {
      const std::lock_guard guard(stage_.mutex());
      start.table.append(table, table.size() - 1);
      return joined();
    };
    Trials trials({input_.problem, evaluator, table, stage_.how(), evaluated}, plan_.limits, start.from.design);
    const bool measurable = !stage_.has_front() || table.status[0] != Status::failed;
    std::optional<StartOutcome> outcome = solve_start(*plan_.solver, trials, table, input_.seed + k, measurable);
    if (!outcome) return;
    outcome->origin = start.from.origin;
    const std::lock_guard guard(stage_.mutex());
    start.outcome = std::move(*outcome);
    start.ended = true;
    if (!leads()) {
      std::string message(reinterpret_cast<const char*>(&input_.seed), sizeof input_.seed);
      pack_start(stage_.known_of(k), message);
      ranks::post(message);
    }
    joined();
  }

  /// After each evaluation, with the stage's mutex. False: stop.
  bool joined() {
    if (ranks::size() > 1) {
      if (!leads()) {
        // Rank 0 says when to stop; to ask it costs a message.
        const auto now = std::chrono::steady_clock::now();
        if (now - asked_ < std::chrono::milliseconds(100)) return !stage_.stopped();
        asked_ = now;
        if (stops_->next(0) > 0) stage_.stop();
        return !stage_.stopped();
      }
      while (const auto message = ranks::poll()) {
        std::uint64_t stage = 0;  // messages may outlive the stage that they were sent in
        std::memcpy(&stage, message->data(), sizeof stage);
        if (stage == input_.seed) know(*message, sizeof stage);
      }
    }
    if (!stage_.join()) stops_->next();
    return !stage_.stopped();
  }

  /// Every rank has what all have found, or knows that the stage was stopped.
  void agree() {
    std::string mine;
    for (std::size_t k = 0; k < stage_.starts().size(); ++k)
      if (stage_.starts()[k].here) pack_start(stage_.known_of(k), mine);
    for (const std::string& bytes : ranks::all_gather(mine)) know(bytes, 0);
    if (leads()) stage_.join();
    std::string state(1, stage_.stopped() ? kStopped : kDone);
    if (leads()) state += std::to_string(hash_of_rows(table_, 0, table_.size()));
    ranks::broadcast(state);
    if (state.front() == kStopped) return stage_.stop();
    if (leads()) return;
    stage_.join();
    if (state.substr(1) != std::to_string(hash_of_rows(table_, 0, table_.size())))
      ranks::abandon("what the solver's starts have come to differs from what rank 0 on " + ranks::host(0) +
                     " has: the same program with the same libraries has to run on every host");
  }

  void know(const std::string& bytes, std::size_t at) {
    while (at < bytes.size()) stage_.know(unpack_start(bytes, at, table_.shape()));
  }

  static constexpr char kStopped = 's', kDone = 'd';

  const SolverPlan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  JoinedStarts stage_;
  ranks::Counter* stops_ = nullptr;  ///< above 0: rank 0 has stopped
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

class SolverStage final : public Optimiser {
 public:
  explicit SolverStage(SolverPlan plan) : plan_(std::move(plan)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    return Run(plan_, input, table)();
  }
  std::int64_t evaluation_limit(const Problem&) const override {
    return (plan_.starts + plan_.multistart) * plan_.limits.evaluations;
  }
  std::int64_t at_once() const override { return plan_.side_by_side ? plan_.starts + plan_.multistart : 1; }
  Detail detail() const override { return plan_.detail; }

 private:
  SolverPlan plan_;
};

}  // namespace

std::unique_ptr<Optimiser> make_solver_stage(SolverPlan plan) { return std::make_unique<SolverStage>(std::move(plan)); }

}  // namespace pkm
