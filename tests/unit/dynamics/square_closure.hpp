// Another way to solve the equations of all bodies: with as many couples set to zero as make the system square.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "engine/dynamics/newton_euler.hpp"

namespace pkm::test {

/// The unknowns [N, N m] when redundant couples are 0. Forces are those of least_norm(). Needs as many unknowns as
/// equations to remain (std::logic_error otherwise); infinite or NaN at a singularity.
/// @param redundant  tells of a joint and the number of one of its couples
template <class Redundant>
Eigen::VectorXd square_closure(const NewtonEuler& system, const Redundant& redundant) {
  const LinearEquations e = equations(system);
  std::vector<Eigen::Index> kept;
  Eigen::Index column = 0;
  for (const Joint& joint : system.joints) {
    for (int force = 0; force < 3; ++force) kept.push_back(column++);
    for (std::size_t couple = 0; couple < joint.couples.size(); ++couple, ++column)
      if (!redundant(joint, couple)) kept.push_back(column);
  }
  if (static_cast<Eigen::Index>(kept.size()) != e.A.rows())
    throw std::logic_error("the square closure leaves " + std::to_string(kept.size()) + " unknowns for " +
                           std::to_string(e.A.rows()) + " equations");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(e.A.cols());
  const Eigen::VectorXd found = Eigen::PartialPivLU<Eigen::MatrixXd>(e.A(Eigen::all, kept)).solve(e.b);
  x(kept) = found;
  return x;
}

}  // namespace pkm::test
