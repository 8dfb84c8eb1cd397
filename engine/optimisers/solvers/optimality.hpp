// KKT residual and Lagrange multipliers of an evaluated design, computed from its derivatives, independently of the
// solver.
//
// With the minimised objective f and the constraints c >= 0 as functions of the unit cube coordinates u, a local
// optimum has multipliers lambda, mu >= 0 (Karush-Kuhn-Tucker conditions) with
//
//   grad f - sum over active constraints of lambda_i grad c_i - sum over active bounds of mu_k (+- e_k) = 0.
//
// The multipliers are the non-negative least-squares solution of this equation (active-set method of Lawson and Hanson
// 1974, chapter 23). The KKT residual, here called optimality, is the largest component of the left-hand side, divided
// by the magnitude of the objective: the relative improvement still possible, to first order, per full range of a
// variable.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/problem/problem.hpp"

namespace pkm {

struct ActiveBound {
  std::size_t variable = 0;
  bool upper = false;
  double multiplier = 0;  ///< improvement of the objective per unit by which the bound is relaxed, >= 0
};

struct ActiveConstraint {
  std::size_t margin = 0;  ///< index of the constraint among the constraint values
  double multiplier = 0;   ///< improvement of the objective per unit by which the constraint is relaxed, >= 0
};

struct Optimality {
  /// KKT residual: largest component of the Lagrangian's gradient, divided by the objective's magnitude in
  /// optimality(), but not in evaluate_kkt().
  double optimality = 0;
  std::vector<ActiveBound> bounds;
  std::vector<ActiveConstraint> margins;
};

/// Evaluates the KKT conditions at a point of the unit cube. The residual is not divided by the magnitude of the
/// objective; it is NaN if the multipliers cannot be computed.
/// @param u                coordinates in [0, 1]; a bound is active within 1e-7
/// @param gradient         gradient of the minimised objective
/// @param margins          constraint values, satisfied if >= 0; active if a step of 1e-7 can reduce them to 0
/// @param margin_jacobian  constraints x variables
Optimality evaluate_kkt(std::span<const double> u, std::span<const double> gradient, std::span<const double> margins,
                        std::span<const double> margin_jacobian);

/// Evaluates the KKT conditions of an evaluated design, for the first objective. Multipliers are per physical unit of a
/// variable; the residual is relative to max(size, |f|).
/// @param design       values of the variables
/// @param derivatives  values and derivatives of the design's evaluation, laid out as described at
/// EvaluationShape::derivatives
/// @param size         magnitude of the objective that is used if |f| is smaller, as it is if f vanishes at the optimum
Optimality optimality(const Problem& problem, std::span<const double> design, std::span<const double> derivatives,
                      double size = 0);

/// Projects a point of the unit cube onto the linearised active constraints (minimum-norm Newton step). Coordinates on
/// a bound are fixed; the other coordinates may leave the unit cube.
/// @param activity_tolerance  a constraint is active if a step of this length can reduce it to 0
/// @return nullopt if no constraint is active, or if all coordinates are fixed
std::optional<std::vector<double>> project_onto_active_constraints(const std::vector<double>& point,
                                                                   std::span<const double> margins,
                                                                   std::span<const double> margin_jacobian,
                                                                   double activity_tolerance);

}  // namespace pkm
