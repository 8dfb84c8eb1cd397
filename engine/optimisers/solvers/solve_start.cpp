#include "engine/optimisers/solvers/solve_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {
namespace {

constexpr double kSnap = 1e-6;  // in the unit cube: what lies so near to a bound or margin is tried on it as well
constexpr double kOptimal = 1e-6;
constexpr int kRounds = 4;  // of a solver from one start

/// Of the start's evaluations whose objective and margins are the best one's but for a solver's rounding, the one with
/// the least first-order optimality; without derivatives, the best.
std::size_t most_stationary(const Trials& trials, const EvaluationTable& table) {
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

/// What a solver returns need not be its best point, nor one it has asked for (SLSQP may leave the optimum again). And
/// it ends a little inside of bounds and margins, so what lies on those that are active is tried too.
/// False: what is kept was on the way, and the solver ended elsewhere.
bool finish(Trials& trials, const EvaluationTable& table, const std::vector<double>& returned) {
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

SolverEnd solve_in_rounds(const Solver& solver, Trials& trials, const EvaluationTable& table, std::uint64_t seed) {
  SolverEnd end;
  std::vector<double> from = trials.start();
  for (int round = 0; round < kRounds && trials.stop() == Trials::Stop::none; ++round) {
    const std::int64_t before = trials.best().row;
    end = solver.solve(trials, from, seed);
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
  return end;
}

/// Whether the objective has a slope at a start at which its gradient is 0 and no bound is active: then the gradient is
/// wrong, and nothing has converged. By one central difference along a direction that no symmetry of the variables
/// cancels; its two evaluations are recorded. At a stationary point the difference is small beside the curvature.
bool contradicts_flat_start(Trials& trials) {
  constexpr double kStep = 1e-3;   // in the unit cube
  constexpr double kNoise = 1e-7;  // of the objective: above the errors of its values
  const std::vector<double> start = trials.recall(0);
  const Trials::Point at = trials.point();
  const auto is_inside = [](double u) { return u >= kStep && u <= 1 - kStep; };
  if (!at.usable || at.gradient.empty() || !std::ranges::all_of(start, is_inside) ||
      !std::ranges::all_of(at.gradient, [](double slope) { return slope == 0; }))
    return false;
  const auto beside = [&](double step) -> std::optional<double> {
    std::vector<double> point = start;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double share = 0.618 * static_cast<double>(i);
      point[i] += step * (1 - 0.5 * (share - std::floor(share)));
    }
    const Trials::Point* const there = trials.at(point.data());
    return there && there->usable ? std::optional(there->objective) : std::nullopt;
  };
  const auto low = beside(-kStep), high = low ? beside(kStep) : std::nullopt;
  if (!high) return false;
  const double bend = std::fabs(*high - 2 * at.objective + *low);
  const double noise = kNoise * std::max({std::fabs(at.objective), std::fabs(*low), std::fabs(*high)});
  return std::fabs(*high - *low) > std::max(bend, noise);
}

/// Solvers may fail by rounding at the very optimum: where the slopes say that it is one, it has converged.
StopReason stop_reason(Trials::Stop stop, const SolverEnd& end, double optimality) {
  if (stop == Trials::Stop::evaluations) return StopReason::evaluations;
  if (stop == Trials::Stop::time) return StopReason::time;
  if (optimality <= kOptimal) return StopReason::tolerance;
  return end.converged && stop != Trials::Stop::not_a_point ? StopReason::tolerance : StopReason::failed;
}

}  // namespace

std::optional<StartOutcome> solve_start(const Solver& solver, Trials& trials, const EvaluationTable& table,
                                        std::uint64_t seed, bool measurable) {
  SolverEnd end;
  if (measurable)
    end = solve_in_rounds(solver, trials, table, seed);
  else
    end.message = "the start's evaluation failed, and several objectives are measured from it";
  const bool stays = trials.best().row == 0 && trials.stop() == Trials::Stop::none;
  const bool contradicted = measurable && stays && contradicts_flat_start(trials);
  trials.rethrow();
  if (trials.stop() == Trials::Stop::interrupted) return {};
  StartOutcome outcome;
  outcome.rows = static_cast<std::int64_t>(table.size());
  outcome.end_row = trials.best().row;
  outcome.message =
      trials.stop() == Trials::Stop::not_a_point ? "asked for a design that is not a number" : end.message;
  outcome.optimality = trials.optimality(static_cast<std::size_t>(outcome.end_row));
  const StopReason reason = stop_reason(trials.stop(), end, outcome.optimality);
  outcome.stop = words(reason);
  // The numbers that stand for failed evaluations are flat: a solver may well take them for an optimum.
  if (measurable && reason == StopReason::tolerance && trials.best().status == Status::failed) {
    outcome.message = "none of its designs could be evaluated";
    outcome.stop = words(StopReason::failed);
  }
  if (contradicted) {
    outcome.message = "the gradient is 0 at the start, but the objective changes beside it";
    outcome.stop = words(StopReason::failed);
    outcome.optimality = std::numeric_limits<double>::quiet_NaN();
  }
  return outcome;
}

}  // namespace pkm
