// A solver's view of a problem: points of the unit cube, an objective to be minimised, margins that must be >= 0.
//
// Solvers ask for objective, constraints and gradients one by one and often several times; one point is one evaluation,
// with the slopes if the solver wants any. Every evaluation goes through the start's evaluator into its table, so a
// resumed run repeats it from the record. The objective is divided by its size at the start: tolerances are relative.
// Of several objectives a goal makes one (see goal.hpp).
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
#include "engine/optimisers/solvers/goal.hpp"
#include "engine/problem/order.hpp"

namespace pkm {

/// Bounds of one start.
struct TrialLimits {
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  std::optional<double> seconds;
};

/// What one start works in.
struct TrialRoom {
  const Problem& problem;
  Evaluator& evaluator;
  EvaluationTable& table;  ///< of this start alone; empty
  const Scalarisation& how;
  std::function<bool()> evaluated;  ///< after each evaluation; false: stop
};

class Trials {
 public:
  /// Why no further point is evaluated.
  enum class Stop { none, evaluations, time, interrupted, not_a_point, exception };

  using Point = GoalPoint;  ///< where the evaluation failed, its numbers stand for a bad design

  /// Evaluates the start and scales by it.
  Trials(const TrialRoom& room, const TrialLimits& limits, std::span<const double> start);

  std::size_t dimension() const { return goal_->dimension(); }
  std::size_t margins() const { return goal_->margins(); }
  const std::vector<double>& start() const { return start_unit_; }

  /// The point u of the unit cube, or null when the solver must stop. Coordinates outside, where solvers may stray by
  /// a rounding error, are moved to the cube's faces; one that is not a number ends the start.
  /// Nothing is thrown: an exception is kept, and `rethrow` throws it once the solver has returned.
  const Point* at(const double* u) noexcept;
  /// Goes back to an evaluation of this start: the unit point of that row, which `at` then knows.
  std::vector<double> recall(std::size_t row);
  /// The point evaluated or recalled last.
  const Point& point() const { return point_; }
  Stop stop() const { return stop_; }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

  const Goal& goal() const { return *goal_; }
  /// First-order optimality of a row of this start, relative to the objective there or at the start, whichever is
  /// larger; NaN without derivatives.
  double optimality(std::size_t row) const;

  /// Best evaluation of this start.
  const Ranked& best() const { return best_; }

 private:
  void evaluate(std::span<const double> u);
  void set(std::size_t row);
  void read(std::size_t row, double slack);

  TrialRoom room_;
  EvaluationTable& table_;
  TrialLimits limits_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<double> start_design_, start_unit_, unit_;
  double start_size_ = 0;        ///< of the objective at the start; 0: not usable
  std::optional<Goal> goal_;     ///< once the start is evaluated
  std::size_t row_ = 0;          ///< of the point evaluated or recalled last
  std::optional<double> worst_;  ///< greatest objective seen
  Point point_;
  Ranked best_;
  Stop stop_ = Stop::none;
  std::exception_ptr exception_;
};

}  // namespace pkm
