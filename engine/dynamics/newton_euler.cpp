#include "engine/dynamics/newton_euler.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace pkm {
namespace {

using Eigen::Index;

Eigen::Vector3d eigen(const Vector<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// A joint with the numbers of its columns: three forces from the first on, behind them its couples.
struct JointColumns {
  const Joint& joint;
  Index first, couples;  ///< where they begin
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

/// Components of a joint's couple along x, y, z; none where the null space reaches it.
std::array<std::optional<double>, 3> couple_of(const JointColumns& at, const LeastNorm& solution) {
  std::array<std::optional<double>, 3> couple;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double value = 0;
    Eigen::RowVectorXd free = Eigen::RowVectorXd::Zero(solution.null_space.cols());
    for (Index k = 0; k < at.couple_count; ++k) {
      const double share = at.joint.couples[static_cast<std::size_t>(k)][axis];
      value += share * solution.x[at.couples + k];
      // a matrix without columns has no address to count its rows from
      if (free.size() > 0) free += share * solution.null_space.row(at.couples + k);
    }
    if (free.norm() < kUniqueTolerance) couple[axis] = value;
  }
  return couple;
}

}  // namespace

LinearEquations equations(const NewtonEuler& system) {
  const std::vector<JointColumns> columns = columns_of(system);
  const auto rows = static_cast<Index>(6 * system.bodies.size());
  const Index unknowns = columns.empty() ? 0 : columns.back().couples + columns.back().couple_count;
  LinearEquations e{Eigen::MatrixXd::Zero(rows, unknowns), Eigen::VectorXd(rows)};
  // what a joint's unknowns do to a body; sign -1 for the one that feels the opposite
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

LeastNorm least_norm(const NewtonEuler& system) {
  LinearEquations e = equations(system);
  const std::vector<JointColumns> columns = columns_of(system);
  const double length = couple_length(system);
  // moments and couples divided by the length, so that all entries are forces per force
  for (Index row = 3; row < e.A.rows(); row += 6) {
    e.A.middleRows<3>(row) /= length;
    e.b.segment<3>(row) /= length;
  }
  for (const JointColumns& at : columns) e.A.middleCols(at.couples, at.couple_count) *= length;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kRankTolerance);
  decomposition.compute(e.A);
  const Index rank = decomposition.rank(), unknowns = e.A.cols();
  LeastNorm solution{.x = decomposition.solve(e.b), .null_space = {}, .rank = static_cast<int>(rank)};
  for (const JointColumns& at : columns) solution.x.segment(at.couples, at.couple_count) *= length;
  // A = Q [T 0; 0 0] Z P^T: the last columns of P Z^T span what A does not see.
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
      forces[actuator->joint] = eigen(actuator->axis).dot(solution.segment<3>(at.first)) + actuator->on_slide;
  return forces;
}

Reactions reactions(const NewtonEuler& system) {
  const LeastNorm solution = least_norm(system);
  const std::vector<JointColumns> columns = columns_of(system);
  const bool forces_are_unique = solution.null_space.cols() == 0 || std::ranges::all_of(columns, [&](const auto& at) {
                                   const auto freedom = solution.null_space.middleRows<3>(at.first);
                                   return freedom.rowwise().norm().maxCoeff() < kUniqueTolerance;
                                 });
  Reactions found;
  found.equations = static_cast<int>(6 * system.bodies.size());
  found.unknowns = static_cast<int>(solution.x.size());
  found.rank = solution.rank;
  if (found.rank < found.equations || !solution.x.allFinite() || !forces_are_unique) {
    found.reason =
        "the mechanism is at a singularity, where the equations of its bodies do not determine the forces (" +
        std::to_string(found.equations) + " equations of rank " + std::to_string(found.rank) + ")";
    return found;
  }
  found.drive_forces = drive_forces(system, solution.x);
  for (const JointColumns& at : columns) {
    const auto force = solution.x.segment<3>(at.first);
    found.joints.push_back(
        {at.joint.name, system.bodies[at.joint.on].name, {force[0], force[1], force[2]}, couple_of(at, solution)});
  }
  return found;
}

}  // namespace pkm
