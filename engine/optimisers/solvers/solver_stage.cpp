#include "engine/optimisers/solvers/solver_stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/optimisers/front_keeper.hpp"
#include "engine/optimisers/solvers/optimality.hpp"
#include "engine/optimisers/start.hpp"
#include "engine/problem/replay.hpp"

namespace pkm {
namespace {

constexpr double kSnap = 1e-6;  // in the unit cube: what lies so near to a bound or margin is tried on it as well
constexpr double kOptimal = 1e-6;
constexpr int kRounds = 4;  // of a solver from one start

// One run of a stage.
class Run {
 public:
  Run(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
      : plan_(plan), stage_{input, table, plan.scalarisation}, input_(stage_.input), table_(table) {
    const auto& objectives = input.problem.objectives();
    if (objectives.size() == 1) return;
    stage_.how.extents = input.known_front.extents;
    FrontPlan front;
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      if (objectives[k].name == plan.objective) stage_.how.objective = k;
      if (!input.known_front.reference.empty()) front.reference[objectives[k].name] = input.known_front.reference[k];
    }
    front_.emplace(front, input.problem, table);
  }

  StageResult operator()() {
    const std::vector<StartDesign> starts = all_starts();
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const bool goes_on = on_record(k) ? repeat(input_.recorded_starts[k]) : begin(k, starts[k]);
      if (!goes_on) return {StopReason::interrupted, stage_.best.row, stage_.finished};
      if (front_) keep_end();
    }
    StageResult result{reason(), stage_.best.row, stage_.finished};
    if (front_) result.front = front_->front();
    return result;
  }

 private:
  /// The end of the start that has just ended becomes a point of the stage's front.
  void keep_end() {
    front_->add(std::array{stage_.finished.back().end_row});
    if (front_->compromise_row() >= 0)
      stage_.best = ranked(input_.problem.objectives(), table_, static_cast<std::size_t>(front_->compromise_row()));
  }

  std::vector<StartDesign> all_starts() const {
    std::vector<StartDesign> starts = input_.starts;
    const DesignSpace& space = input_.problem.space();
    const auto count = static_cast<std::size_t>(plan_.multistart);
    const auto units = start_points(Start::sobol, count, space.dimension(), input_.seed);
    for (std::size_t k = 0; k < count; ++k) {
      StartDesign start{{}, "Sobol point " + std::to_string(k + 1)};
      for (std::size_t i = 0; i < space.dimension(); ++i)
        start.design.push_back(space.from_unit(i, units[k * space.dimension() + i]));
      starts.push_back(std::move(start));
    }
    return starts;
  }

  // Ended on record, and not by a limit that has been raised since.
  bool on_record(std::size_t k) const {
    if (k >= input_.recorded_starts.size()) return false;
    const StartOutcome& outcome = input_.recorded_starts[k];
    return outcome.stop != words(StopReason::evaluations) || outcome.rows >= plan_.limits.evaluations;
  }

  // Copies the start's rows; the evaluator serves their results. False: the monitor wants to stop.
  bool repeat(const StartOutcome& outcome) {
    const std::size_t first = table_.size();
    input_.evaluator.follow(first, static_cast<std::size_t>(outcome.first_row),
                            static_cast<std::size_t>(outcome.first_row + outcome.rows));
    StartOutcome again = outcome;
    again.first_row = static_cast<std::int64_t>(first);
    again.end_row = outcome.end_row - outcome.first_row + again.first_row;
    Ranked best;
    std::optional<Goal> goal;
    for (std::int64_t i = 0; i < outcome.rows; ++i) {
      const std::size_t row = table_.extend(1);
      std::ranges::copy(input_.recorded->design(static_cast<std::size_t>(outcome.first_row + i)),
                        table_.design(row).begin());
      input_.evaluator.evaluate(input_.problem, table_, row);
      if (!goal) goal.emplace(stage_.how, input_.problem, table_, row);
      if (!stage_.take(row, *goal, best)) return false;
    }
    stage_.finished.push_back(std::move(again));
    return true;
  }

  bool begin(std::size_t k, const StartDesign& start) {
    const std::size_t first = table_.size();
    const std::int64_t generation = stage_.generation;
    const Ranked best = stage_.best;
    const auto [record_first, record_end] = record_of(k);
    input_.evaluator.follow(first, record_first, record_end);
    try {
      return solve(k, start);
    } catch (const ReplayMismatch&) {
      input_.monitor.warn("Start " + std::to_string(k + 1) + " (" + start.origin +
                          ") left the path on record, as solvers may on another processor; it began anew.");
      table_.truncate(first);
      stage_.generation = generation;
      stage_.best = best;
      input_.evaluator.follow(first, 0, 0);
      return solve(k, start);
    }
  }

  /// The recorded rows of start k: those after the starts before it, up to those of the next start that is on record.
  std::pair<std::size_t, std::size_t> record_of(std::size_t k) const {
    if (!input_.recorded) return {0, 0};
    const auto& ended = input_.recorded_starts;
    if (k < ended.size()) {
      const auto first = static_cast<std::size_t>(ended[k].first_row);
      return {first, first + static_cast<std::size_t>(ended[k].rows)};
    }
    if (k > ended.size()) return {0, 0};
    const std::size_t first = ended.empty() ? 0 : static_cast<std::size_t>(ended.back().first_row + ended.back().rows);
    return {first, input_.recorded->size()};
  }

  bool solve(std::size_t k, const StartDesign& start) {
    Trials trials(stage_, plan_.limits, start.design);
    SolverEnd end;
    std::vector<double> from = trials.start();
    const bool measurable = !front_ || table_.status[trials.first_row()] != Status::failed;
    if (!measurable) end.message = "the start's evaluation failed, and several objectives are measured from it";
    for (int round = 0; measurable && round < kRounds && trials.stop() == Trials::Stop::none; ++round) {
      const std::int64_t before = trials.best().row;
      end = plan_.solver->solve(trials, from, input_.seed + k);
      trials.rethrow();
      if (trials.stop() == Trials::Stop::none && !finish(trials, end.point))
        end.message += "; ended worse than a design on the way, which is kept";
      trials.rethrow();
      // A solver that gave up short of the optimum (a line search that failed by rounding) begins anew where it stood.
      const auto best = static_cast<std::size_t>(trials.best().row);
      const bool gained = trials.best().row != before;
      if (!gained || !(trials.optimality(best) > kOptimal)) break;
      from = trials.recall(best);
    }
    if (trials.stop() == Trials::Stop::interrupted) return false;
    StartOutcome outcome;
    outcome.origin = start.origin;
    outcome.first_row = static_cast<std::int64_t>(trials.first_row());
    outcome.rows = static_cast<std::int64_t>(table_.size() - trials.first_row());
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
    stage_.finished.push_back(std::move(outcome));
    return true;
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
  bool finish(Trials& trials, const std::vector<double>& returned) const {
    bool at_best = true;
    if (returned.size() == trials.dimension()) {
      const Trials::Point* at = trials.at(returned.data());
      if (!at) return true;
      const double end = at->objective;
      trials.recall(static_cast<std::size_t>(trials.best().row));
      const double best = trials.point().objective;
      at_best = end <= best + kSnap * std::max(1.0, std::fabs(best));
    }
    std::vector<double> point = trials.recall(most_stationary(trials));
    for (double& u : point) u = u < kSnap ? 0 : u > 1 - kSnap ? 1 : u;
    const Trials::Point* at = trials.at(point.data());
    if (!at || !at->usable || at->gradient.empty()) return at_best;
    if (const auto moved = onto_margins(point, at->margins, at->margin_gradient, kSnap)) trials.at(moved->data());
    return at_best;
  }

  // Of the start's evaluations whose objective and margins are the best one's but for a solver's rounding, the one with
  // the least first-order optimality; without derivatives, the best.
  std::size_t most_stationary(const Trials& trials) const {
    constexpr double kRounding = 1e-9;
    auto chosen = static_cast<std::size_t>(trials.best().row);
    if (table_.shape().detail != Detail::derivatives || table_.status[chosen] == Status::failed) return chosen;
    const Goal& goal = trials.goal();
    const double best = goal.value(chosen);
    double least = trials.optimality(chosen);
    for (std::size_t row = trials.first_row(); row < table_.size(); ++row) {
      if (table_.status[row] == Status::failed || goal.violation(row) > kRounding) continue;
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
      if (std::ranges::all_of(stage_.finished, [&](const StartOutcome& o) { return o.stop == words(each); }))
        return each;
    return StopReason::starts;
  }

  const SolverPlan& plan_;
  Starts stage_;
  const StageInput& input_;
  EvaluationTable& table_;
  std::optional<FrontKeeper> front_;  ///< several objectives: of the ends
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
  Detail detail() const override { return plan_.detail; }

 private:
  SolverPlan plan_;
};

}  // namespace

std::unique_ptr<Optimiser> make_solver_stage(SolverPlan plan) { return std::make_unique<SolverStage>(std::move(plan)); }

}  // namespace pkm
