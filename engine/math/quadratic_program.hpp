// Convex quadratic programs of few variables: minimise x'Bx/2 + c'x subject to A x >= b, by a primal-dual
// interior-point method with Mehrotra's predictor-corrector steps.
//
// Reference: J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd edition, Springer, 2006, section 16.6.
#pragma once

#include <Eigen/Core>

namespace pkm {

struct QuadraticProgram {
  Eigen::MatrixXd B;  ///< n x n, symmetric and positive definite
  Eigen::VectorXd c;
  Eigen::MatrixXd A;  ///< m x n
  Eigen::VectorXd b;
};

struct QuadraticSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;  ///< >= 0, one per constraint: B x + c = A' multipliers
};

/// Solves a program that has a solution with A x > b; elements should be of the order of 1.
QuadraticSolution solve(const QuadraticProgram& program);

}  // namespace pkm
