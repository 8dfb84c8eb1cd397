// First-order tolerance analysis of a design: gradients of objectives and margins with respect to all parameters of the
// mechanism, and the worst case of each within tolerances of the parameters.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// An objective or a margin of a design, with its gradient.
struct QuantityGradient {
  std::string name, unit;
  double value;
  double worse_sign;       ///< -1 or 1: sign of a change of the value that makes the quantity worse
  std::vector<double> by;  ///< derivatives of the quantity with respect to all parameters [SI]
};

/// The gradients of all objectives, then of all margins. Precondition: the problem has derivatives.
/// @param report  evaluation of the design
std::vector<QuantityGradient> quantity_gradients(const DesignProblem& problem, const DesignReport& report);

/// Worst value of a quantity for parameters within +- their tolerances.
struct WorstCase {
  double first_order;  ///< first-order estimate of the worst value, from the gradient
  double rss;          ///< root of the sum of the squared first-order changes due to each parameter
  double evaluated;  ///< value at the vertex of the tolerance box that is worst to first order; NaN: evaluation failed
};
/// Worst value of one quantity within tolerances of the parameters.
/// @param gradients  quantity_gradients() of the design
/// @param k          index of the quantity in `gradients`
/// @param tolerance  by parameter, >= 0 [SI]
WorstCase worst_case(const DesignProblem& problem, const DesignReport& report,
                     const std::vector<QuantityGradient>& gradients, std::size_t k, std::span<const double> tolerance);

}  // namespace pkm
