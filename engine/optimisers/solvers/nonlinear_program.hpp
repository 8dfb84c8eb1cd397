// Nonlinear program as a solver sees it: minimise an objective over the unit cube subject to constraints g(u) >= 0.
//
// Solvers request objective, constraints and gradients in separate calls, often repeatedly. Each point is nevertheless
// evaluated only once, with derivatives if the solver uses them. All evaluations are recorded in the table of the
// multistart run, so that a resumed run can replay them. The objective is divided by its magnitude at the start design,
// so that solver tolerances are relative. Several objectives are scalarised (scalarised_problem.hpp).
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimisers/optimiser.hpp"
#include "engine/optimisers/solvers/scalarised_problem.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {

/// Limits of the evaluations and of the time of one multistart run.
struct StartLimits {
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  std::optional<double> seconds;
};

/// Problem, evaluator and evaluation table of the solver run from one start design.
struct StartContext {
  const Problem& problem;
  Evaluator& evaluator;
  EvaluationTable& table;  ///< evaluations of this run only; initially empty, the first row is the start design
  const Scalarisation& scalarisation;
  std::function<bool()> evaluated;  ///< called after each evaluation; a return value of false stops the solver
};

class NonlinearProgram {
 public:
  /// Reason why no further point is evaluated; `none` while evaluations continue.
  enum class Stop { none, evaluations, time, interrupted, not_finite, exception };

  using Point = NlpPoint;  ///< after a failed evaluation, its objective is a penalty value

  /// Evaluates the start design. Its objective values define the scaling of the program.
  NonlinearProgram(const StartContext& context, const StartLimits& limits, std::span<const double> start);

  std::size_t dimension() const { return scalarised_->dimension(); }
  std::size_t constraints() const { return scalarised_->constraints(); }
  const std::vector<double>& start() const { return start_unit_; }

  /// Evaluates a point of the unit cube, or returns null if the solver must stop. Coordinates are clamped to [0, 1],
  /// because solvers may leave the bounds by rounding errors; a coordinate that is not finite stops the solver.
  /// Exceptions must not pass through the solver libraries: they are stored, and `rethrow` throws them after the solver
  /// has returned.
  const Point* evaluate(const double* u) noexcept;
  /// Makes a row that is already evaluated the current point, and returns its coordinates in the unit cube. A call of
  /// `evaluate` with these coordinates then needs no new evaluation.
  std::vector<double> recall(std::size_t row);
  /// The current point, i.e. the one that was evaluated or recalled last.
  const Point& point() const { return point_; }
  Stop stop() const { return stop_; }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

  const ScalarisedProblem& scalarised() const { return *scalarised_; }
  /// KKT residual of a row of this multistart run, divided by the magnitude of the objective at this row or at the
  /// start design, whichever is larger; NaN without derivatives.
  double optimality(std::size_t row) const;

  /// Rank key of the best evaluation of this multistart run, as ranked by the scalarised problem.
  const RankKey& best() const { return best_; }

 private:
  void evaluate_new_row(std::span<const double> u);
  void select_row(std::size_t row);
  void update_point(std::size_t row, double epigraph);

  StartContext context_;
  EvaluationTable& table_;
  StartLimits limits_;
  std::chrono::steady_clock::time_point start_time_ = std::chrono::steady_clock::now();
  std::vector<double> start_design_, start_unit_, current_unit_;
  /// Magnitude of the objective at the start design; 0: the evaluation of the start design failed.
  double start_scale_ = 0;
  std::optional<ScalarisedProblem> scalarised_;  ///< set after the evaluation of the start design
  std::size_t row_ = 0;                          ///< row number of the current point
  std::optional<double> max_objective_;          ///< maximum of the scaled objective over the evaluations so far
  Point point_;
  RankKey best_;
  Stop stop_ = Stop::none;
  std::exception_ptr exception_;
};

}  // namespace pkm
