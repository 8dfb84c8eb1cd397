#include "engine/dynamics/newton_euler.hpp"

#include <algorithm>
#include <cmath>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm {
namespace {

using Eigen::Index;

Eigen::Vector3d eigen(const Vector<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// A joint and the columns of its unknowns in the equations: three forces, followed by the couples.
struct JointColumns {
  const Joint& joint;
  Index first, couples;  ///< indices of the first column of the forces and of the first column of the couples
  Index couple_count;
};
std::vector<JointColumns> columns_of(const NewtonEuler& system) {
  std::vector<JointColumns> columns;
  Index next = 0;
  for (const Joint& joint : system.joints) {
    columns.push_back({joint, next, next + 3, static_cast<Index>(joint.couples.size())});
    next = columns.back().couples + columns.back().couple_count;
  }
  return columns;
}

/// A component of a joint's force or couple, as a linear combination of consecutive unknowns of the equations.
struct Component {
  Index first;
  Eigen::VectorXd weights;

  double in(const Eigen::VectorXd& solution) const { return weights.dot(solution.segment(first, weights.size())); }
  /// Returns true if the component is unique: no unit vector of the null space changes it by more than the tolerance.
  bool is_determined(const MinNormSolution& solution) const {
    if (solution.null_space.cols() == 0 || weights.size() == 0) return true;
    const auto rows = solution.null_space.middleRows(first, weights.size());
    return (weights.transpose() * rows).norm() < kUniqueTolerance;
  }
  std::optional<double> determined(const MinNormSolution& solution) const {
    return is_determined(solution) ? std::optional(in(solution.x)) : std::nullopt;
  }
};
Component force_along(const JointColumns& at, const Eigen::Vector3d& direction) { return {at.first, direction}; }
Component couple_along(const JointColumns& at, const Eigen::Vector3d& direction) {
  Component component{at.couples, Eigen::VectorXd(at.couple_count)};
  for (Index k = 0; k < at.couple_count; ++k)
    component.weights[k] = direction.dot(eigen(at.joint.couples[static_cast<std::size_t>(k)]));
  return component;
}
/// The component of a joint's force or couple that its actuator exerts.
Component actuation(const JointColumns& at) {
  const Eigen::Vector3d axis = eigen(at.joint.actuator->axis);
  return at.joint.actuator->turns ? couple_along(at, axis) : force_along(at, axis);
}

}  // namespace

LinearEquations equations(const NewtonEuler& system) {
  const std::vector<JointColumns> columns = columns_of(system);
  const auto rows = static_cast<Index>(6 * system.bodies.size());
  const Index unknowns = columns.empty() ? 0 : columns.back().couples + columns.back().couple_count;
  LinearEquations e{Eigen::MatrixXd::Zero(rows, unknowns), Eigen::VectorXd(rows)};
  // Adds the columns of a joint to the rows of a body. `sign` is -1 for the body on which the opposite loads act.
  const auto add_joint = [&](const JointColumns& at, std::size_t body, double sign) {
    const auto row = static_cast<Index>(6 * body);
    const Eigen::Vector3d r = eigen(at.joint.point - system.bodies[body].centre) * sign;
    e.A.block<3, 3>(row, at.first).diagonal().array() += sign;
    e.A.block<3, 3>(row + 3, at.first) += Eigen::Matrix3d{{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
    for (Index k = 0; k < at.couple_count; ++k)
      e.A.block<3, 1>(row + 3, at.couples + k) += eigen(at.joint.couples[static_cast<std::size_t>(k)]) * sign;
  };
  for (const JointColumns& at : columns) {
    add_joint(at, at.joint.on, 1);
    if (at.joint.from) add_joint(at, *at.joint.from, -1);
  }
  for (Index row = 0; const RigidBody& body : system.bodies) {
    const Vector<double, 3> weight{{0, 0, -body.mass * kGravity}};
    e.b.segment<3>(row) = eigen(body.a * body.mass - weight - body.force);
    e.b.segment<3>(row + 3) =
        eigen(body.inertia * body.epsilon + cross(body.omega, body.inertia * body.omega) - body.moment);
    row += 6;
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

MinNormSolution min_norm_solution(const NewtonEuler& system) {
  LinearEquations e = equations(system);
  const std::vector<JointColumns> columns = columns_of(system);
  const double length = couple_length(system);
  // Moment equations are divided by the characteristic length, and the columns of couples are multiplied by it, so
  // that A is dimensionless.
  for (Index row = 3; row < e.A.rows(); row += 6) {
    e.A.middleRows<3>(row) /= length;
    e.b.segment<3>(row) /= length;
  }
  for (const JointColumns& at : columns) e.A.middleCols(at.couples, at.couple_count) *= length;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kRankTolerance);
  decomposition.compute(e.A);
  const Index rank = decomposition.rank(), unknowns = e.A.cols();
  MinNormSolution solution{.x = decomposition.solve(e.b), .null_space = {}, .rank = static_cast<int>(rank)};
  for (const JointColumns& at : columns) solution.x.segment(at.couples, at.couple_count) *= length;
  // With the decomposition A = Q [T 0; 0 0] Z P^T, the last columns of P Z^T span the null space of A.
  solution.null_space.resize(unknowns, 0);
  if (rank < unknowns)
    solution.null_space = decomposition.colsPermutation() *
                          Eigen::MatrixXd(decomposition.matrixZ().transpose().rightCols(unknowns - rank));
  return solution;
}

AxisVector<double> drive_forces(const NewtonEuler& system, const Eigen::VectorXd& solution) {
  std::size_t actuators = 0;
  for (const Joint& joint : system.joints)
    if (joint.actuator) actuators = std::max(actuators, joint.actuator->joint + 1);
  AxisVector<double> forces(actuators);
  for (const JointColumns& at : columns_of(system))
    if (const auto& actuator = at.joint.actuator)
      forces[actuator->joint] += actuation(at).in(solution) + actuator->on_slide;
  return forces;
}

Reactions reactions(const NewtonEuler& system) {
  const MinNormSolution solution = min_norm_solution(system);
  const std::vector<JointColumns> columns = columns_of(system);
  const bool drives_are_determined = std::ranges::all_of(
      columns, [&](const JointColumns& at) { return !at.joint.actuator || actuation(at).is_determined(solution); });
  Reactions found;
  found.equations = static_cast<int>(6 * system.bodies.size());
  found.unknowns = static_cast<int>(solution.x.size());
  found.rank = solution.rank;
  if (found.rank < found.equations || !solution.x.allFinite() || !drives_are_determined) {
    found.reason =
        "the mechanism is at a singularity, where the equations of its bodies do not determine the forces (" +
        std::to_string(found.equations) + " equations of rank " + std::to_string(found.rank) + ")";
    return found;
  }
  found.drive_forces = drive_forces(system, solution.x);
  for (const JointColumns& at : columns) {
    JointReaction joint{at.joint.name, system.bodies[at.joint.on].name, {}, {}};
    for (Index axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      joint.force[k] = force_along(at, Eigen::Vector3d::Unit(axis)).determined(solution);
      joint.couple[k] = couple_along(at, Eigen::Vector3d::Unit(axis)).determined(solution);
    }
    found.joints.push_back(std::move(joint));
  }
  return found;
}

}  // namespace pkm
