#include "engine/dynamics/newton_euler.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/QR>

namespace pkm {
namespace {

using Eigen::Index;

Eigen::Vector3d eigen(const Vector<double, 3>& v) { return {v[0], v[1], v[2]}; }

Index rows_of(const NewtonEuler& system) { return static_cast<Index>(6 * system.bodies.size()); }

/// Where each joint's columns begin, and their number at the end.
std::vector<Index> first_columns(const NewtonEuler& system) {
  std::vector<Index> first = {0};
  for (const Joint& joint : system.joints) first.push_back(first.back() + 3 + static_cast<Index>(joint.couples.size()));
  return first;
}

/// Adds to a body's rows what a joint's unknowns do to it; sign -1 for the body that feels the opposite.
void add_joint(Eigen::MatrixXd& A, const NewtonEuler& system, const Joint& joint, std::size_t body, double sign,
               Index column) {
  const Index row = static_cast<Index>(6 * body);
  const Eigen::Vector3d r = eigen(joint.point - system.bodies[body].centre) * sign;
  A.block<3, 3>(row, column).diagonal().array() += sign;
  A.block<3, 3>(row + 3, column) += Eigen::Matrix3d{{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
  for (std::size_t k = 0; k < joint.couples.size(); ++k)
    A.block<3, 1>(row + 3, column + 3 + static_cast<Index>(k)) += eigen(joint.couples[k].direction) * sign;
}

/// Moments and couples divided by the length, so that all entries are forces per force.
void make_dimensionless(const NewtonEuler& system, double length, LinearEquations& e) {
  for (Index row = 3; row < e.A.rows(); row += 6) {
    e.A.middleRows<3>(row) /= length;
    e.b.segment<3>(row) /= length;
  }
  const std::vector<Index> first = first_columns(system);
  for (std::size_t j = 0; j < system.joints.size(); ++j)
    e.A.middleCols(first[j] + 3, first[j + 1] - first[j] - 3) *= length;
}

/// Components of a joint's couple along x, y, z; none where the null space reaches it.
std::array<std::optional<double>, 3> couple_of(const Joint& joint, const LeastNorm& solution, Index first) {
  std::array<std::optional<double>, 3> couple;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double value = 0;
    Eigen::RowVectorXd free = Eigen::RowVectorXd::Zero(solution.null_space.cols());
    for (std::size_t k = 0; k < joint.couples.size(); ++k) {
      const Index column = first + 3 + static_cast<Index>(k);
      value += joint.couples[k].direction[axis] * solution.x[column];
      if (free.size() > 0) free += joint.couples[k].direction[axis] * solution.null_space.row(column);
    }
    if (free.norm() < kUniqueTolerance) couple[axis] = value;
  }
  return couple;
}

bool forces_are_unique(const NewtonEuler& system, const LeastNorm& solution) {
  if (solution.null_space.cols() == 0) return true;
  const std::vector<Index> first = first_columns(system);
  for (std::size_t j = 0; j < system.joints.size(); ++j)
    if (solution.null_space.middleRows<3>(first[j]).rowwise().norm().maxCoeff() >= kUniqueTolerance) return false;
  return true;
}

}  // namespace

LinearEquations equations(const NewtonEuler& system) {
  const std::vector<Index> first = first_columns(system);
  LinearEquations e{Eigen::MatrixXd::Zero(rows_of(system), first.back()), Eigen::VectorXd(rows_of(system))};
  for (std::size_t j = 0; j < system.joints.size(); ++j) {
    const Joint& joint = system.joints[j];
    add_joint(e.A, system, joint, joint.on, 1, first[j]);
    if (joint.from) add_joint(e.A, system, joint, *joint.from, -1, first[j]);
  }
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const RigidBody& body = system.bodies[k];
    const Vector<double, 3> weight{{0, 0, -body.mass * kGravity}};
    const Index row = static_cast<Index>(6 * k);
    e.b.segment<3>(row) = eigen(body.a * body.mass - weight - body.force);
    e.b.segment<3>(row + 3) =
        eigen(body.inertia * body.epsilon + cross(body.omega, body.inertia * body.omega) - body.moment);
  }
  return e;
}

double couple_length(const NewtonEuler& system) {
  double sum = 0;
  for (const Joint& joint : system.joints) {
    const Vector<double, 3> r = joint.point - system.bodies[joint.on].centre;
    sum += dot(r, r);
  }
  return sum > 0 ? std::sqrt(sum / static_cast<double>(system.joints.size())) : 1;
}

LeastNorm least_norm(const NewtonEuler& system) {
  LinearEquations e = equations(system);
  const double length = couple_length(system);
  make_dimensionless(system, length, e);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kRankTolerance);
  decomposition.compute(e.A);
  LeastNorm solution;
  const Index rank = decomposition.rank(), unknowns = e.A.cols();
  solution.rank = static_cast<int>(rank);
  solution.x = decomposition.solve(e.b);
  const std::vector<Index> first = first_columns(system);
  for (std::size_t j = 0; j < system.joints.size(); ++j)
    solution.x.segment(first[j] + 3, first[j + 1] - first[j] - 3) *= length;
  // A = Q [T 0; 0 0] Z P^T: the last columns of P Z^T span what A does not see.
  solution.null_space.resize(unknowns, 0);
  if (rank < unknowns)
    solution.null_space = decomposition.colsPermutation() *
                          Eigen::MatrixXd(decomposition.matrixZ().transpose().rightCols(unknowns - rank));
  return solution;
}

Eigen::VectorXd square_closure(const NewtonEuler& system) {
  const LinearEquations e = equations(system);
  const std::vector<Index> first = first_columns(system);
  std::vector<Index> kept;
  for (std::size_t j = 0; j < system.joints.size(); ++j)
    for (Index column = first[j]; column < first[j + 1]; ++column) {
      const Index couple = column - first[j] - 3;
      if (couple < 0 || !system.joints[j].couples[static_cast<std::size_t>(couple)].redundant) kept.push_back(column);
    }
  if (static_cast<Index>(kept.size()) != e.A.rows())
    throw std::logic_error("the square closure leaves " + std::to_string(kept.size()) + " unknowns for " +
                           std::to_string(e.A.rows()) + " equations");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(e.A.cols());
  const Eigen::VectorXd found = Eigen::PartialPivLU<Eigen::MatrixXd>(e.A(Eigen::all, kept)).solve(e.b);
  x(kept) = found;
  return x;
}

AxisVector<double> drive_forces(const NewtonEuler& system, const Eigen::VectorXd& solution) {
  const std::vector<Index> first = first_columns(system);
  std::size_t actuators = 0;
  for (const Joint& joint : system.joints)
    if (joint.actuator) actuators = std::max(actuators, joint.actuator->joint + 1);
  AxisVector<double> forces(actuators);
  for (std::size_t j = 0; j < system.joints.size(); ++j)
    if (const auto& actuator = system.joints[j].actuator)
      forces[actuator->joint] = eigen(actuator->axis).dot(solution.segment<3>(first[j])) + actuator->on_slide;
  return forces;
}

Reactions reactions(const NewtonEuler& system) {
  const LeastNorm solution = least_norm(system);
  const std::vector<Index> first = first_columns(system);
  Reactions found;
  found.equations = static_cast<int>(rows_of(system));
  found.unknowns = static_cast<int>(first.back());
  found.rank = solution.rank;
  if (found.rank < found.equations || !solution.x.allFinite() || !forces_are_unique(system, solution)) {
    found.reason =
        "the mechanism is at a singularity, where the equations of its bodies do not determine the forces (" +
        std::to_string(found.equations) + " equations of rank " + std::to_string(found.rank) + ")";
    return found;
  }
  found.drive_forces = drive_forces(system, solution.x);
  for (std::size_t j = 0; j < system.joints.size(); ++j) {
    const Joint& joint = system.joints[j];
    const auto force = solution.x.segment<3>(first[j]);
    found.joints.push_back({joint.name,
                            system.bodies[joint.on].name,
                            {force[0], force[1], force[2]},
                            couple_of(joint, solution, first[j])});
  }
  return found;
}

}  // namespace pkm
