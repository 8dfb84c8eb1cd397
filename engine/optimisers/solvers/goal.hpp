// What one start of a solver minimises: the problem's objective, or one number made of several objectives.
//
// Of several objectives f_i (turned so that less is better), measured from where the start stands, f_i0, in units of
// the front's extents r_i:
//
//   epsilon-constraint (Haimes et al. 1971):  min f_j / |f_j0|            subject to  f_i <= f_i0  for all i
//   achievement (Wierzbicki 1980):            min t + rho sum_i g_i       subject to  g_i <= t <= 0
//                                             with  g_i = (f_i - f_i0) / r_i
//
// Either way what a solver ends with dominates its start or equals it. A start that is not feasible has nothing to
// keep: there f_i <= f_i0 is left out, and t may be positive. t is one more variable of the unit cube, within 10
// extents; rho = 1e-4 keeps it from ending where one objective could still be had for nothing.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/optimisers/optimiser.hpp"
#include "engine/problem/order.hpp"

namespace pkm {

struct Scalarisation {
  enum class Kind { none, achievement, epsilon };
  Kind kind = Kind::none;
  std::size_t objective = 0;         ///< epsilon: the one that is minimised
  std::vector<double> extents = {};  ///< r_i, > 0
};

/// A point of the unit cube as solvers see it.
struct GoalPoint {
  double objective = 0;                 ///< to be minimised, scaled
  std::vector<double> gradient;         ///< of the objective, per unit of the unit cube; empty without derivatives
  std::vector<double> margins;          ///< >= 0 holds
  std::vector<double> margin_gradient;  ///< margins x variables
  bool usable = false;                  ///< false: the evaluation failed, and the numbers say nothing
};

/// Reads evaluations as the goal of one start.
class Goal {
 public:
  /// @param start  the row in which the start is evaluated: what the goal is measured from and scaled by
  Goal(const Scalarisation& scalarisation, const Problem& problem, const EvaluationTable& table, std::size_t start);

  /// Whether the unit cube has one more variable, the last.
  bool has_slack() const { return how_.kind == Scalarisation::Kind::achievement; }
  std::size_t dimension() const { return problem_.space().dimension() + (has_slack() ? 1 : 0); }
  std::size_t margins() const;

  /// @param slack  the variable of that name; ignored where there is none
  void read(std::size_t row, double slack, GoalPoint& point) const;
  /// The least slack with which the row's goal holds.
  double slack(std::size_t row) const;

  /// How good a row is as an end of this start. Stored values count, not the smooth ones that solvers see.
  Ranked rank(std::size_t row) const;
  /// Sum of what a row breaks; 0 where it is as good as its start in every objective and its margins hold.
  double violation(std::size_t row) const;
  double value(std::size_t row) const;
  /// What a difference of two values is small against.
  double size(double value) const { return has_slack() ? 1 : std::fabs(value); }

 private:
  std::size_t objectives() const { return problem_.objectives().size(); }
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }
  double stored(std::size_t row, std::size_t k) const { return sign(k) * table_.objective_row(row)[k]; }
  double smooth(std::size_t row, std::size_t k) const;
  /// (f_k - f_k0) / r_k, as solvers see it.
  double gain(std::size_t row, std::size_t k) const { return (smooth(row, k) - from_[k]) / how_.extents[k]; }
  /// t of the slack u, and its range.
  double t_of(double u) const { return least_t() + u * (most_t() - least_t()); }
  static double least_t() { return -10; }
  double most_t() const { return keeps_ ? 0 : 10; }
  void add_gradient(std::size_t row, std::size_t k, double factor, std::span<double> gradient) const;

  const Scalarisation& how_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::size_t start_;
  std::vector<double> from_;  ///< smooth values at the start
  double scale_ = 1;          ///< of the one objective
  bool keeps_ = true;         ///< the start is feasible: no objective may become worse
};

}  // namespace pkm
