// Scalarisation of a problem with several objectives for a single-objective solver: epsilon-constraint method or
// achievement function. A problem with one objective is passed on unchanged, but scaled.
//
// With the minimised objectives f_i, their values f_i0 at the start design, and the ranges r_i of the known front:
//
//   epsilon-constraint (Haimes et al. 1971):  min f_j / |f_j0|            subject to  f_i <= f_i0  for all i
//   achievement (Wierzbicki 1980):            min t + rho sum_i g_i       subject to  g_i <= t <= 0
//                                             with  g_i = (f_i - f_i0) / r_i
//
// Both return a design that dominates the start or has equal objectives. For an infeasible start, the objectives may
// become worse: f_i <= f_i0 is omitted, and t may be positive. The achievement function is in epigraph form: t, with
// |t| <= 10, is an additional variable, mapped to [0, 1]. The augmentation term, rho = 1e-4, excludes solutions that
// are only weakly Pareto optimal, at which one objective could still improve while the others stay constant.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "engine/optimisers/optimiser.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {

struct Scalarisation {
  enum class Kind { none, achievement, epsilon };
  Kind kind = Kind::none;
  std::size_t objective = 0;         ///< epsilon-constraint method: index of the minimised objective
  std::vector<double> extents = {};  ///< the range r_i of each objective over the known front, > 0
};

/// Objective and constraints of the nonlinear program at a point of the unit cube.
struct NlpPoint {
  double objective = 0;          ///< objective that the solver minimises, after scaling
  std::vector<double> gradient;  ///< gradient with respect to the unit coordinates; empty without derivatives
  std::vector<double> margins;   ///< constraint values, satisfied if >= 0
  /// Derivatives of the constraints with respect to the unit coordinates, one row per constraint.
  std::vector<double> margin_jacobian;
  bool usable = false;  ///< false: the evaluation failed, and the other members are meaningless
};

/// The scalarised problem of one multistart run. Reads evaluations of the original problem from an evaluation table.
class ScalarisedProblem {
 public:
  /// @param start  row of the evaluated start design, whose objective values f_i0 define constraints and scaling
  ScalarisedProblem(const Scalarisation& scalarisation, const Problem& problem, const EvaluationTable& table,
                    std::size_t start);

  /// Returns true if the solver has the additional variable t, which is the last coordinate of the unit cube.
  bool has_epigraph() const { return scalarisation_.kind == Scalarisation::Kind::achievement; }
  std::size_t dimension() const { return problem_.space().dimension() + (has_epigraph() ? 1 : 0); }
  std::size_t constraints() const;

  /// Computes objective, constraints and derivatives of the nonlinear program from an evaluated row of the evaluation
  /// table.
  /// @param epigraph  coordinate of t in [0, 1]; ignored if the program has no variable t
  void read(std::size_t row, double epigraph, NlpPoint& point) const;
  /// Coordinate, in [0, 1], of the smallest value of the variable t that is not below any scaled change g_i of an
  /// objective from the start design to this row; 0 if the program has no variable t.
  double epigraph(std::size_t row) const;

  /// Rank key of a row as a candidate for the result of this multistart run. It uses the objective values of the
  /// evaluation table, not the smooth approximations that the solver minimises.
  RankKey rank(std::size_t row) const;
  /// Sum of the violations of all constraints of the problem and of the constraints f_i <= f_i0, i.e. that no objective
  /// is worse than at the start design; 0 if all are satisfied.
  double violation(std::size_t row) const;
  /// Scalarised objective of a row, computed from the objective values of the evaluation table.
  double value(std::size_t row) const;
  /// Magnitude by which differences of value() are divided before they are compared with a tolerance.
  double scale_of(double value) const { return has_epigraph() ? 1 : std::fabs(value); }

 private:
  std::size_t objectives() const { return problem_.objectives().size(); }
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }
  double stored_value(std::size_t row, std::size_t k) const { return sign(k) * table_.objective_row(row)[k]; }
  double smooth_value(std::size_t row, std::size_t k) const;
  /// Change g_k = (f_k - f_k0) / r_k of objective k from the start design to a row, divided by its range r_k over the
  /// known front; f_k are smooth approximations.
  double scaled_change(std::size_t row, std::size_t k) const {
    return (smooth_value(row, k) - start_values_[k]) / scalarisation_.extents[k];
  }
  /// The value of the variable t for its coordinate u in [0, 1].
  double t_from_unit(double u) const { return t_min() + u * (t_max() - t_min()); }
  static double t_min() { return -10; }
  double t_max() const { return start_is_feasible_ ? 0 : 10; }
  void add_gradient(std::size_t row, std::size_t k, double factor, std::span<double> gradient) const;

  const Scalarisation& scalarisation_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::size_t start_;
  std::vector<double> start_values_;  ///< smooth approximations of the objectives f_i0 at the start design
  double scale_ = 1;                  ///< factor by which the single minimised objective is multiplied
  bool start_is_feasible_ = true;     ///< true: no objective may become worse than at the start design
};

}  // namespace pkm
