// Convex quadratic programs of few variables: minimise x'Bx/2 + c'x subject to A x >= b, by a primal-dual
// interior-point method with Mehrotra's predictor-corrector steps.
//
// Reference: J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd edition, Springer, 2006, section 16.6.
#pragma once

#include <Eigen/Core>

namespace pkm {

struct QuadraticProgram {
  Eigen::MatrixXd B;  ///< n x n matrix of the objective, symmetric and positive definite
  Eigen::VectorXd c;
  Eigen::MatrixXd A;  ///< m x n matrix: one row per constraint
  Eigen::VectorXd b;
};

struct QuadraticSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;  ///< m values >= 0, one per constraint, with B x + c = A' multipliers at the solution
};

/// Solves a program for which a point with A x > b exists. Elements should be of the order of 1, because the
/// tolerances of the solution are absolute.
QuadraticSolution solve(const QuadraticProgram& program);

}  // namespace pkm
