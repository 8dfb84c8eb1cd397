#include "engine/optimisers/solvers/solve_from_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {
namespace {

// Distance in unit coordinates below which a bound or constraint counts as active.
constexpr double kSnapDistance = 1e-6;
constexpr double kOptimalityTolerance = 1e-6;  // KKT residual up to which a design counts as converged
constexpr int kMaxSolverRuns = 4;              // maximum number of solver calls for one start

/// Row number of the evaluation with the smallest KKT residual, among those whose objective equals the best one up to
/// the rounding errors of a solver. Without derivatives, the best row.
std::size_t most_stationary(const NonlinearProgram& program, const EvaluationTable& table) {
  constexpr double kRoundingTolerance = 1e-9;
  auto chosen = static_cast<std::size_t>(program.best().row);
  if (table.shape().detail != Detail::derivatives || table.status[chosen] == Status::failed) return chosen;
  const ScalarisedProblem& scalarised = program.scalarised();
  const double best = scalarised.value(chosen);
  double minimum = program.optimality(chosen);
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.status[row] == Status::failed || scalarised.violation(row) > kRoundingTolerance) continue;
    if (!(std::fabs(scalarised.value(row) - best) <= kRoundingTolerance * scalarised.scale_of(best))) continue;
    if (const double here = program.optimality(row); here < minimum) {
      minimum = here;
      chosen = row;
    }
  }
  return chosen;
}

/// Evaluates the returned point, then the best point moved onto nearby bounds, and finally this point moved onto its
/// active constraints. The returned point need not be the best one, nor one that the solver has evaluated (SLSQP may
/// leave the optimum again), and solvers end slightly inside bounds and constraints.
/// @return false if the returned point is worse than the best one
bool polish(NonlinearProgram& program, const EvaluationTable& table, const std::vector<double>& returned) {
  bool ended_at_best = true;
  if (returned.size() == program.dimension()) {
    const NonlinearProgram::Point* last = program.evaluate(returned.data());
    if (!last) return true;
    const double returned_objective = last->objective;
    program.recall(static_cast<std::size_t>(program.best().row));
    const double best = program.point().objective;
    ended_at_best = returned_objective <= best + kSnapDistance * std::max(1.0, std::fabs(best));
  }
  std::vector<double> point = program.recall(most_stationary(program, table));
  for (double& u : point) u = u < kSnapDistance ? 0 : u > 1 - kSnapDistance ? 1 : u;
  const NonlinearProgram::Point* snapped = program.evaluate(point.data());
  if (!snapped || !snapped->usable || snapped->gradient.empty()) return ended_at_best;
  if (const auto moved =
          project_onto_active_constraints(point, snapped->margins, snapped->margin_jacobian, kSnapDistance))
    program.evaluate(moved->data());
  return ended_at_best;
}

SolverResult solve_repeatedly(const Solver& solver, NonlinearProgram& program, const EvaluationTable& table,
                              std::uint64_t seed) {
  SolverResult result;
  std::vector<double> start = program.start();
  for (int run = 0; run < kMaxSolverRuns && program.stop() == NonlinearProgram::Stop::none; ++run) {
    const std::int64_t previous_best = program.best().row;
    result = solver.solve(program, start, seed);
    program.rethrow();
    if (program.stop() == NonlinearProgram::Stop::none && !polish(program, table, result.point))
      result.message += "; ended worse than a design on the way, which is kept";
    program.rethrow();
    // Restart from the best point if the solver stopped before the optimum, for example by a failed line search.
    const auto best = static_cast<std::size_t>(program.best().row);
    const bool improved = program.best().row != previous_best;
    if (!improved || !(program.optimality(best) > kOptimalityTolerance)) break;
    start = program.recall(best);
  }
  return result;
}

/// Detects a wrong zero gradient: returns true if the gradient is 0 at a start design in the interior of the bounds,
/// although the objective has a non-zero derivative there. Compares with one central difference, along a direction in
/// which symmetries of the variables do not cancel. At a true stationary point the difference is small compared with
/// the second difference.
bool has_wrong_zero_gradient(NonlinearProgram& program) {
  constexpr double kStep = 1e-3;  // step of the difference quotient, in unit coordinates
  // Numerical errors of the objective are smaller than this, relative to its value.
  constexpr double kRelativeNoise = 1e-7;
  const std::vector<double> start = program.recall(0);
  const NonlinearProgram::Point centre = program.point();
  const auto is_inside = [](double u) { return u >= kStep && u <= 1 - kStep; };
  if (!centre.usable || centre.gradient.empty() || !std::ranges::all_of(start, is_inside) ||
      !std::ranges::all_of(centre.gradient, [](double derivative) { return derivative == 0; }))
    return false;
  const auto objective_at = [&](double step) -> std::optional<double> {
    std::vector<double> point = start;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double fraction = 0.618 * static_cast<double>(i);
      point[i] += step * (1 - 0.5 * (fraction - std::floor(fraction)));
    }
    const NonlinearProgram::Point* const neighbour = program.evaluate(point.data());
    return neighbour && neighbour->usable ? std::optional(neighbour->objective) : std::nullopt;
  };
  const auto low = objective_at(-kStep), high = low ? objective_at(kStep) : std::nullopt;
  if (!high) return false;
  const double second_difference = std::fabs(*high - 2 * centre.objective + *low);
  const double noise = kRelativeNoise * std::max({std::fabs(centre.objective), std::fabs(*low), std::fabs(*high)});
  return std::fabs(*high - *low) > std::max(second_difference, noise);
}

/// A solver may report a failure at the optimum, due to rounding errors. Therefore a small KKT residual counts as
/// convergence.
StopReason stop_reason(NonlinearProgram::Stop stop, const SolverResult& result, double optimality) {
  if (stop == NonlinearProgram::Stop::evaluations) return StopReason::evaluations;
  if (stop == NonlinearProgram::Stop::time) return StopReason::time;
  if (optimality <= kOptimalityTolerance) return StopReason::tolerance;
  return result.converged && stop != NonlinearProgram::Stop::not_finite ? StopReason::tolerance : StopReason::failed;
}

}  // namespace

std::optional<StartOutcome> solve_from_start(const Solver& solver, NonlinearProgram& program,
                                             const EvaluationTable& table, std::uint64_t seed, bool start_evaluated) {
  SolverResult result;
  if (start_evaluated)
    result = solve_repeatedly(solver, program, table, seed);
  else
    result.message = "objectives are scalarised relative to the start design, whose evaluation failed";
  const bool start_is_best = program.best().row == 0 && program.stop() == NonlinearProgram::Stop::none;
  const bool has_wrong_gradient = start_evaluated && start_is_best && has_wrong_zero_gradient(program);
  program.rethrow();
  if (program.stop() == NonlinearProgram::Stop::interrupted) return {};
  StartOutcome outcome;
  outcome.rows = static_cast<std::int64_t>(table.size());
  outcome.end_row = program.best().row;
  outcome.message = program.stop() == NonlinearProgram::Stop::not_finite
                        ? "the solver requested a design that is not finite"
                        : result.message;
  outcome.optimality = program.optimality(static_cast<std::size_t>(outcome.end_row));
  const StopReason reason = stop_reason(program.stop(), result, outcome.optimality);
  outcome.stop = words(reason);
  // The penalty value of failed evaluations is constant; a solver may therefore report convergence.
  if (start_evaluated && reason == StopReason::tolerance && program.best().status == Status::failed) {
    outcome.message = "all evaluations failed";
    outcome.stop = words(StopReason::failed);
  }
  if (has_wrong_gradient) {
    outcome.message = "the gradient is 0 at the start, but the objective is not constant around it";
    outcome.stop = words(StopReason::failed);
    outcome.optimality = std::numeric_limits<double>::quiet_NaN();
  }
  return outcome;
}

}  // namespace pkm
