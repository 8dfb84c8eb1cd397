// Newton's and Euler's equations of every body of a mechanism, with all forces and couples in its joints unknown:
//
//   sum F + m g = m a,     sum (M + r x F) = I epsilon + omega x I omega     (about the centre of mass)
//
// A mechanism whose joints constrain it more often than necessary has more unknowns than equations. The rank-revealing
// solution tells what is determined all the same: an unknown is where its row of a basis of the null space vanishes.
// What then remains of a null space are forces and couples that bodies hold against each other; those of the actuators
// are unique.
//
// Source: Transactions of the Chinese Society for Agricultural Machinery 54 (9), 2023, 448-458, section 2.4 with its
// errata (60 equations have 64 unknowns there, not 60).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/reactions.hpp"
#include "engine/dynamics/rigid_body.hpp"

namespace pkm {

/// Which component of a joint's force an actuator exerts, or of its couple, which the joint then carries. Those of one
/// number together are one drive.
struct Actuator {
  std::size_t joint;       ///< number among the mechanism's actuated joints
  Vector<double, 3> axis;  ///< of unit length; forces along it are positive
  /// What the actuator spends before the joint, on a slide of its own: mass times (acceleration - g) along the axis
  /// [N].
  double on_slide = 0;
  bool turns = false;
};

/// Between two bodies, or a body and the ground. It transmits a force in every direction.
struct Joint {
  std::string name;
  Vector<double, 3> point;                 ///< [m]
  std::size_t on;                          ///< body that force and couples act on
  std::optional<std::size_t> from;         ///< body that their opposites act on; none: the ground
  std::vector<Vector<double, 3>> couples;  ///< that it can transmit: directions of unit length
  std::optional<Actuator> actuator;
};

/// Rows: for each body three forces, then three moments. Columns: for each joint three forces, then its couples.
struct NewtonEuler {
  std::vector<RigidBody> bodies;
  std::vector<Joint> joints;
};

/// A x = b in N, N m and m.
struct LinearEquations {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};
LinearEquations equations(const NewtonEuler& system);

/// Solution of least norm, and what of it is determined.
struct LeastNorm {
  Eigen::VectorXd x;           ///< the unknowns in column order [N, N m]
  Eigen::MatrixXd null_space;  ///< orthonormal columns: changes of x / (1 N, couple_length N m) that no body feels
  int rank = 0;
};

/// Length by which couples are divided to be compared with forces: root mean square distance of the joints from the
/// centres of the bodies that they act on, 1 m where all are in them [m]. The least norm depends on it, what is
/// determined does not.
double couple_length(const NewtonEuler& system);

/// By complete orthogonal decomposition; pivots below kRankTolerance of the greatest are 0.
inline constexpr double kRankTolerance = 1e-10;
LeastNorm least_norm(const NewtonEuler& system);

/// Forces of the actuators in a solution, by the number of their joints [N, N m].
AxisVector<double> drive_forces(const NewtonEuler& system, const Eigen::VectorXd& solution);

/// Everything that is determined, by the solution of least norm. An unknown is when no null vector of length 1 moves
/// it by kUniqueTolerance.
inline constexpr double kUniqueTolerance = 1e-9;
Reactions reactions(const NewtonEuler& system);

}  // namespace pkm
