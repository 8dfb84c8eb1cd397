// First-order optimality of an evaluated design, worked out from its slopes alone, whatever solver found it.
//
// With f the objective to be minimised and c >= 0 the margins, both as functions of the unit cube u, a local optimum
// has multipliers >= 0 (Karush, Kuhn, Tucker) with
//
//   grad f - sum over active margins of lambda_i grad c_i - sum over active bounds of mu_k (+- e_k) = 0.
//
// The multipliers are the non-negative least-squares solution (Lawson and Hanson 1974, chapter 23); what is left of the
// gradient, divided by the objective's size, is the optimality: the relative gain per full range of a variable that is
// still to be had to first order.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/problem/problem.hpp"

namespace pkm {

struct ActiveBound {
  std::size_t variable = 0;
  bool upper = false;
  double multiplier = 0;  ///< gain of the objective per unit of the variable, in the objective's direction
};

struct ActiveMargin {
  std::size_t margin = 0;
  double multiplier = 0;  ///< gain of the objective per unit by which the margin is relaxed
};

struct Optimality {
  double optimality = 0;  ///< largest component of what is left of the gradient, relative to the objective
  std::vector<ActiveBound> bounds;
  std::vector<ActiveMargin> margins;
};

/// That of a point of the unit cube, not relative to anything; NaN where the multipliers do not settle.
/// @param u                in the unit cube
/// @param gradient         of the objective, to be minimised
/// @param margins          >= 0 holds; active within what a step of 1e-7 changes it by
/// @param margin_gradient  margins x variables
Optimality first_order(std::span<const double> u, std::span<const double> gradient, std::span<const double> margins,
                       std::span<const double> margin_gradient);

/// @param design  the variables
/// @param slopes  as in EvaluationShape::slopes
/// @param size    of the objective, for an objective that is 0 at the optimum; |f| counts where it is larger
/// A bound is active within 1e-7 of the variable's range, a margin within what such a step changes it by.
Optimality optimality(const Problem& problem, std::span<const double> design, std::span<const double> slopes,
                      double size = 0);

/// The nearest point of the unit cube at which the margins that are nearly 0 are 0 to first order; coordinates that lie
/// on a bound stay there. None: nothing to move.
/// @param near  of a margin: what a step of this length changes it by
std::optional<std::vector<double>> onto_margins(const std::vector<double>& point, std::span<const double> margins,
                                                std::span<const double> margin_gradient, double near);

/// min |A x - b| over x >= 0. A is given by columns, each as long as b. Throws std::runtime_error when it does not
/// settle.
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               const std::vector<double>& b);

}  // namespace pkm
