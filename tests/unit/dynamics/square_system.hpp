// Independent solution of the Newton-Euler equations of overconstrained mechanisms: redundant couples are set to zero,
// so that the system becomes square and is solved by LU decomposition.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "engine/dynamics/newton_euler.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm::test {

/// The unknowns [N, N m] with redundant couples 0; determined forces equal those of min_norm_solution(). Infinite or
/// NaN at a singularity. Throws std::logic_error unless the remaining unknowns are as many as the equations.
/// @param redundant  redundant(joint, k): true if couple k of the joint is to be 0
template <class Redundant>
Eigen::VectorXd solve_square_system(const NewtonEuler& system, const Redundant& redundant) {
  const LinearEquations e = equations(system);
  std::vector<Eigen::Index> remaining;
  Eigen::Index column = 0;
  for (const Joint& joint : system.joints) {
    for (int force = 0; force < 3; ++force) remaining.push_back(column++);
    for (std::size_t couple = 0; couple < joint.couples.size(); ++couple, ++column)
      if (!redundant(joint, couple)) remaining.push_back(column);
  }
  if (static_cast<Eigen::Index>(remaining.size()) != e.A.rows())
    throw std::logic_error("square system: found " + std::to_string(remaining.size()) + " unknowns; expected " +
                           std::to_string(e.A.rows()));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(e.A.cols());
  const Eigen::VectorXd found = Eigen::PartialPivLU<Eigen::MatrixXd>(e.A(Eigen::all, remaining)).solve(e.b);
  x(remaining) = found;
  return x;
}

}  // namespace pkm::test
