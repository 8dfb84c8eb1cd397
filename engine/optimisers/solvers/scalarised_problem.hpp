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
  std::size_t objective = 0;         ///< epsilon-constraint: index of the minimised objective
  std::vector<double> extents = {};  ///< the ranges r_i, > 0
};

/// Objective and constraints of the nonlinear program at a point of the unit cube.
struct NlpPoint {
  double objective = 0;                 ///< minimised, scaled
  std::vector<double> gradient;         ///< gradient with respect to the unit coordinates; empty without derivatives
  std::vector<double> margins;          ///< constraint values, satisfied if >= 0
  std::vector<double> margin_jacobian;  ///< constraints x variables
  bool usable = false;                  ///< false: the evaluation failed, the other members are meaningless
};

/// The scalarised problem of one start. Reads evaluations of the original problem from a table.
class ScalarisedProblem {
 public:
  /// @param start  row of the evaluated start design, which defines the f_i0 and the scaling
  ScalarisedProblem(const Scalarisation& scalarisation, const Problem& problem, const EvaluationTable& table,
                    std::size_t start);

  /// True if the unit cube has the additional variable t, as its last coordinate.
  bool has_epigraph() const { return scalarisation_.kind == Scalarisation::Kind::achievement; }
  std::size_t dimension() const { return problem_.space().dimension() + (has_epigraph() ? 1 : 0); }
  std::size_t constraints() const;

  /// Computes objective, constraints and derivatives of a row.
  /// @param epigraph  unit coordinate of t; ignored if there is none
  void read(std::size_t row, double epigraph, NlpPoint& point) const;
  /// Smallest unit coordinate of t that satisfies g_i <= t for the row; 0 if there is no t.
  double epigraph(std::size_t row) const;

  /// Rank of a row as the result of this start. Uses the stored objective values, not the smooth approximations that
  /// the solver sees.
  RankKey rank(std::size_t row) const;
  /// Total violation of the constraints of the problem and of f_i <= f_i0; 0 if all are satisfied.
  double violation(std::size_t row) const;
  /// Scalarised objective, from stored values.
  double value(std::size_t row) const;
  /// Magnitude relative to which differences of `value` are judged.
  double scale_of(double value) const { return has_epigraph() ? 1 : std::fabs(value); }

 private:
  std::size_t objectives() const { return problem_.objectives().size(); }
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }
  double stored_value(std::size_t row, std::size_t k) const { return sign(k) * table_.objective_row(row)[k]; }
  double smooth_value(std::size_t row, std::size_t k) const;
  /// g_k = (f_k - f_k0) / r_k, from smooth values.
  double scaled_change(std::size_t row, std::size_t k) const {
    return (smooth_value(row, k) - start_values_[k]) / scalarisation_.extents[k];
  }
  /// The variable t for a unit coordinate u in [0, 1].
  double t_from_unit(double u) const { return t_min() + u * (t_max() - t_min()); }
  static double t_min() { return -10; }
  double t_max() const { return start_is_feasible_ ? 0 : 10; }
  void add_gradient(std::size_t row, std::size_t k, double factor, std::span<double> gradient) const;

  const Scalarisation& scalarisation_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::size_t start_;
  std::vector<double> start_values_;  ///< f_i0, from smooth values
  double scale_ = 1;                  ///< factor of the single minimised objective
  bool start_is_feasible_ = true;     ///< true: no objective may become worse
};

}  // namespace pkm
