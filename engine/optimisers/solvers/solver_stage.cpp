#include "engine/optimisers/solvers/solver_stage.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/core/ranks.hpp"
#include "engine/optimisers/front_keeper.hpp"
#include "engine/optimisers/solvers/optimality.hpp"
#include "engine/optimisers/start.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/row_exchange.hpp"

namespace pkm {
namespace {

constexpr double kSnap = 1e-6;  // in the unit cube: what lies so near to a bound or margin is tried on it as well
constexpr double kOptimal = 1e-6;
constexpr int kRounds = 4;  // of a solver from one start

/// A start with what is known of it.
struct StartRun {
  StartDesign from;
  EvaluationTable table;     ///< its evaluations so far, which a solver adds to
  EvaluationTable recorded;  ///< those on record; they are not less than they were
  bool ended = false;
  bool here = false;          ///< this rank works on it
  StartOutcome outcome = {};  ///< rows from 0
  std::string warning = {};

  /// What a checkpoint should hold of it: the record until it has been overtaken.
  const EvaluationTable& known() const { return !ended && recorded.size() > table.size() ? recorded : table; }
};

/// The stage's table, which starts join in their order.
class Stage {
 public:
  Stage(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
      : input_(input), table_(table), how_(plan.scalarisation) {
    const auto& objectives = input.problem.objectives();
    if (objectives.size() == 1) return;
    how_.extents = input.known_front.extents;
    FrontPlan front;
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      if (objectives[k].name == plan.objective) how_.objective = k;
      if (!input.known_front.reference.empty()) front.reference[objectives[k].name] = input.known_front.reference[k];
    }
    front_.emplace(front, input.problem, table);
  }

  const Scalarisation& how() const { return how_; }
  bool has_front() const { return front_.has_value(); }
  std::vector<StartRun>& starts() { return starts_; }
  const std::vector<StartOutcome>& finished() const { return finished_; }
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }
  /// One thread at a time changes what is known of starts, and joins them.
  std::mutex& mutex() { return mutex_; }

  /// Adds to the table what is known next, and reports it. False: the monitor wants to stop. Ranks after the first do
  /// so at the stage's end.
  bool join() {
    while (!stopped_ && next_ < starts_.size()) {
      StartRun& start = starts_[next_];
      // A replay may leave the recorded path, and begin anew.
      if (!start.ended && start.table.size() <= start.recorded.size()) break;
      while (!stopped_ && joined_ < start.table.size()) stopped_ = !report(start.table, joined_++);
      if (stopped_ || !start.ended) break;
      end(start);
    }
    if (!stopped_ && !input_.monitor.goes_on()) stopped_ = true;
    return !stopped_;
  }

  /// What another rank knows of a start.
  void know(StartAhead&& of) {
    StartRun& start = starts_.at(static_cast<std::size_t>(of.number));
    if (start.ended) return;
    start.ended = of.outcome.has_value();
    if (start.ended) start.outcome = std::move(*of.outcome);
    (start.ended ? start.table : start.recorded) = std::move(of.table);
  }

  /// What is known beyond the table.
  std::vector<StartAhead> ahead() const {
    std::vector<StartAhead> known;
    for (std::size_t k = next_; k < starts_.size(); ++k) {
      const StartRun& start = starts_[k];
      if (k == next_ && !start.ended && start.known().size() == joined_) continue;
      if (start.known().size() > 0) known.push_back(known_of(k));
    }
    return known;
  }
  StartAhead known_of(std::size_t k) const {
    const StartRun& start = starts_[k];
    StartAhead known{static_cast<std::int64_t>(k), start.known(), {}};
    if (start.ended) known.outcome = start.outcome;
    return known;
  }

  StageResult result(StopReason reason) const {
    StageResult result{reason, best_.row, finished_};
    if (reason == StopReason::interrupted) result.ahead = ahead();
    if (front_ && reason != StopReason::interrupted) result.front = front_->front();
    return result;
  }

 private:
  /// One row of the start that is joining.
  bool report(const EvaluationTable& start, std::size_t source) {
    const std::size_t row = table_.append(start, source);
    if (source == 0) {
      goal_.emplace(how_, input_.problem, table_, row);
      best_of_start_ = {};
    }
    const Ranked candidate = goal_->rank(row);
    if (best_of_start_.row < 0 || candidate < best_of_start_) best_of_start_ = candidate;
    // Of several objectives the stage's best is on its front, which knows the ends of starts.
    if (best_.row < 0 || (how_.kind == Scalarisation::Kind::none && candidate < best_)) best_ = candidate;
    population_ = {best_of_start_.row};
    return input_.monitor.generation({.number = static_cast<std::int64_t>(row),
                                      .first_row = row,
                                      .table = &table_,
                                      .population = &population_,
                                      .best_row = best_.row,
                                      .starts = &finished_,
                                      .ahead = [this] { return ahead(); },
                                      .alone = true});
  }

  void end(StartRun& start) {
    StartOutcome outcome = start.outcome;
    outcome.first_row = static_cast<std::int64_t>(table_.size() - start.table.size());
    outcome.end_row += outcome.first_row;
    if (!start.warning.empty()) input_.monitor.warn(start.warning);
    if (front_) {  // the end becomes a point of the stage's front
      front_->add(std::array{outcome.end_row});
      if (front_->compromise_row() >= 0)
        best_ = ranked(input_.problem.objectives(), table_, static_cast<std::size_t>(front_->compromise_row()));
    }
    finished_.push_back(std::move(outcome));
    if (ranks::size() == 1) start.table = EvaluationTable();  // the stage's table has it; other ranks do not
    ++next_;
    joined_ = 0;
  }

  const StageInput& input_;
  EvaluationTable& table_;
  Scalarisation how_;
  std::vector<StartRun> starts_;
  std::mutex mutex_;
  std::size_t next_ = 0;    ///< the start that is joining
  std::size_t joined_ = 0;  ///< its rows that have
  std::atomic<bool> stopped_ = false;
  std::optional<Goal> goal_;  ///< of the start that is joining
  Ranked best_, best_of_start_;
  std::vector<StartOutcome> finished_;
  std::vector<std::int64_t> population_;  ///< the best of the start that is joining
  std::optional<FrontKeeper> front_;      ///< several objectives: of the ends
};

// One run of a stage.
class Run {
 public:
  Run(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
      : plan_(plan), input_(input), table_(table), stage_(plan, input, table) {}

  StageResult operator()() {
    std::vector<std::size_t> open;
    add_starts();
    for (std::size_t k = 0; k < stage_.starts().size(); ++k)
      if (!stage_.starts()[k].ended) open.push_back(k);
    if (open.size() < stage_.starts().size() && leads()) stage_.join();  // those that had ended
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
    return stage_.result(stage_.stopped() ? StopReason::interrupted : reason());
  }

 private:
  static bool leads() { return ranks::rank() == 0; }

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

  void add_starts() {
    const DesignSpace& space = input_.problem.space();
    const EvaluationShape shape = input_.problem.shape(plan_.detail);
    const auto add = [&](StartDesign from) {
      stage_.starts().push_back({std::move(from), EvaluationTable(shape), EvaluationTable(shape)});
    };
    for (const StartDesign& from : input_.starts) add(from);
    const auto count = static_cast<std::size_t>(plan_.multistart);
    const auto units = start_points(Start::sobol, count, space.dimension(), input_.seed);
    for (std::size_t k = 0; k < count; ++k) {
      StartDesign from{{}, "Sobol point " + std::to_string(k + 1)};
      for (std::size_t i = 0; i < space.dimension(); ++i)
        from.design.push_back(space.from_unit(i, units[k * space.dimension() + i]));
      add(std::move(from));
    }
    if (input_.recorded) read_record();
  }

  void read_record() {
    std::vector<StartRun>& starts = stage_.starts();
    const EvaluationTable& record = *input_.recorded;
    std::size_t next = 0;
    const auto know = [&](std::size_t k, EvaluationTable table, const StartOutcome* outcome) {
      if (k >= starts.size() || table.size() < starts[k].recorded.size()) return;
      starts[k].recorded = std::move(table);
      // Ended, and not by a limit that has been raised since.
      if (!outcome || (outcome->stop == words(StopReason::evaluations) && outcome->rows < plan_.limits.evaluations))
        return;
      starts[k].ended = true;
      starts[k].outcome = *outcome;
      starts[k].table = std::move(starts[k].recorded);
    };
    for (std::size_t k = 0; k < input_.recorded_starts.size(); ++k) {
      StartOutcome outcome = input_.recorded_starts[k];
      outcome.end_row -= std::exchange(outcome.first_row, 0);
      const std::size_t end = next + static_cast<std::size_t>(outcome.rows);
      know(k, record.slice(next, end), &outcome);
      next = end;
    }
    know(input_.recorded_starts.size(), record.slice(next, record.size()), nullptr);
    for (const StartAhead& ahead : input_.recorded_ahead)
      know(static_cast<std::size_t>(ahead.number), ahead.table, ahead.outcome ? &*ahead.outcome : nullptr);
  }

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
    SolverEnd end;
    std::vector<double> from = trials.start();
    const bool measurable = !stage_.has_front() || table.status[0] != Status::failed;
    if (!measurable) end.message = "the start's evaluation failed, and several objectives are measured from it";
    for (int round = 0; measurable && round < kRounds && trials.stop() == Trials::Stop::none; ++round) {
      const std::int64_t before = trials.best().row;
      end = plan_.solver->solve(trials, from, input_.seed + k);
      trials.rethrow();
      if (trials.stop() == Trials::Stop::none && !finish(trials, table, end.point))
        end.message += "; ended worse than a design on the way, which is kept";
      trials.rethrow();
      // A solver that gave up short of the optimum (a line search that failed by rounding) begins anew where it stood.
      const auto best = static_cast<std::size_t>(trials.best().row);
      const bool gained = trials.best().row != before;
      if (!gained || !(trials.optimality(best) > kOptimal)) break;
      from = trials.recall(best);
    }
    if (trials.stop() == Trials::Stop::interrupted) return;
    StartOutcome outcome;
    outcome.origin = start.from.origin;
    outcome.rows = static_cast<std::int64_t>(table.size());
    outcome.end_row = trials.best().row;
    outcome.message =
        trials.stop() == Trials::Stop::not_a_point ? "asked for a design that is not a number" : end.message;
    outcome.optimality = trials.optimality(static_cast<std::size_t>(outcome.end_row));
    outcome.stop = words(stop_reason(trials.stop(), end, outcome.optimality));
    // The numbers that stand for failed evaluations are flat: a solver may well take them for an optimum.
    if (measurable && outcome.stop == words(StopReason::tolerance) && trials.best().status == Status::failed) {
      outcome.message = "none of its designs could be evaluated";
      outcome.stop = words(StopReason::failed);
    }
    const std::lock_guard guard(stage_.mutex());
    start.outcome = std::move(outcome);
    start.ended = true;
    if (!leads()) {
      std::string message(reinterpret_cast<const char*>(&input_.seed), sizeof input_.seed);
      pack_start(stage_.known_of(k), message);
      ranks::post(message);
    }
    joined();
  }

  // Solvers may fail by rounding at the very optimum: where the slopes say that it is one, it has converged.
  static StopReason stop_reason(Trials::Stop stop, const SolverEnd& end, double optimality) {
    if (stop == Trials::Stop::evaluations) return StopReason::evaluations;
    if (stop == Trials::Stop::time) return StopReason::time;
    if (optimality <= kOptimal) return StopReason::tolerance;
    return end.converged && stop != Trials::Stop::not_a_point ? StopReason::tolerance : StopReason::failed;
  }

  // What a solver returns need not be its best point, nor one it has asked for (SLSQP may leave the optimum again).
  // And it ends a little inside of bounds and margins, so what lies on those that are active is tried too.
  // False: what is kept was on the way, and the solver ended elsewhere.
  static bool finish(Trials& trials, const EvaluationTable& table, const std::vector<double>& returned) {
    bool at_best = true;
    if (returned.size() == trials.dimension()) {
      const Trials::Point* at = trials.at(returned.data());
      if (!at) return true;
      const double end = at->objective;
      trials.recall(static_cast<std::size_t>(trials.best().row));
      const double best = trials.point().objective;
      at_best = end <= best + kSnap * std::max(1.0, std::fabs(best));
    }
    std::vector<double> point = trials.recall(most_stationary(trials, table));
    for (double& u : point) u = u < kSnap ? 0 : u > 1 - kSnap ? 1 : u;
    const Trials::Point* at = trials.at(point.data());
    if (!at || !at->usable || at->gradient.empty()) return at_best;
    if (const auto moved = onto_margins(point, at->margins, at->margin_gradient, kSnap)) trials.at(moved->data());
    return at_best;
  }

  // Of the start's evaluations whose objective and margins are the best one's but for a solver's rounding, the one with
  // the least first-order optimality; without derivatives, the best.
  static std::size_t most_stationary(const Trials& trials, const EvaluationTable& table) {
    constexpr double kRounding = 1e-9;
    auto chosen = static_cast<std::size_t>(trials.best().row);
    if (table.shape().detail != Detail::derivatives || table.status[chosen] == Status::failed) return chosen;
    const Goal& goal = trials.goal();
    const double best = goal.value(chosen);
    double least = trials.optimality(chosen);
    for (std::size_t row = 0; row < table.size(); ++row) {
      if (table.status[row] == Status::failed || goal.violation(row) > kRounding) continue;
      if (!(std::fabs(goal.value(row) - best) <= kRounding * goal.size(best))) continue;
      if (const double here = trials.optimality(row); here < least) {
        least = here;
        chosen = row;
      }
    }
    return chosen;
  }

  StopReason reason() const {
    for (const StopReason each : {StopReason::tolerance, StopReason::evaluations, StopReason::time, StopReason::failed})
      if (std::ranges::all_of(stage_.finished(), [&](const StartOutcome& o) { return o.stop == words(each); }))
        return each;
    return StopReason::starts;
  }

  static constexpr char kStopped = 's', kDone = 'd';

  const SolverPlan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  Stage stage_;
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
