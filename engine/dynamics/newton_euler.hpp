// Newton-Euler equations of all bodies of a mechanism, with the forces and couples in all joints as unknowns:
//
//   sum F + m g = m a,     sum (M + r x F) = I epsilon + omega x I omega     (about the centre of mass)
//
// An overconstrained mechanism has more unknowns than equations. A rank-revealing decomposition gives the minimum-norm
// solution and a basis of the null space (internal forces and couples that are in equilibrium with each other). An
// unknown is determined if its row of the null-space basis vanishes. The forces of the actuators are determined except
// at singularities.
//
// Source: Transactions of the Chinese Society for Agricultural Machinery 54 (9), 2023, 448-458, section 2.4 with its
// errata (the 60 equations there have 64 unknowns, not 60).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/reactions.hpp"
#include "engine/dynamics/rigid_body.hpp"

namespace pkm {

/// Marks the component of a joint's force or couple that an actuator exerts. The components of all marks with the same
/// `joint` are added to one drive force.
struct Actuator {
  std::size_t joint;       ///< index of the actuated joint in MechanismInfo::joints
  Vector<double, 3> axis;  ///< direction of a positive drive force, unit vector
  /// Drive force [N] in addition to the force at the joint, if a slider between the actuator and the joint is not
  /// modelled as a body: the mass of the slider times (acceleration - g) along the axis.
  double on_slide = 0;
  bool turns = false;  ///< true: a rotary actuator, which exerts a couple; false: a linear one, which exerts a force
};

/// A joint between two bodies, or between a body and the ground. It transmits forces in all directions.
struct Joint {
  std::string name;
  Vector<double, 3> point;  ///< position of the joint in the world frame [m]
  std::size_t on;           ///< index of the body on which the force and the couples act
  /// Index of the body on which the opposite force and couples act; std::nullopt: the ground.
  std::optional<std::size_t> from;
  std::vector<Vector<double, 3>> couples;  ///< axes of the couples that the joint transmits, unit vectors
  std::optional<Actuator> actuator;
};

/// The system of equations. Rows: three force and three moment equations per body. Columns: three forces per joint,
/// followed by its couples.
struct NewtonEuler {
  std::vector<RigidBody> bodies;
  std::vector<Joint> joints;
};

/// The equations A x = b, with forces in N, couples in N m and lengths in m.
struct LinearEquations {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};
LinearEquations equations(const NewtonEuler& system);

/// The minimum-norm solution of the equations, and a basis of their null space.
struct MinNormSolution {
  Eigen::VectorXd x;  ///< the unknowns, in the order of the columns of NewtonEuler [N, N m]
  /// Orthonormal columns. Components for forces are in units of 1 N, for couples in units of couple_length() N m.
  Eigen::MatrixXd null_space;
  int rank = 0;
};

/// Characteristic length [m] by which couples are made comparable with forces: root mean square distance of the joints
/// from the centres of mass of the bodies on which they act; 1 m if all distances are 0. The minimum-norm solution
/// depends on it, but not its determined components.
double couple_length(const NewtonEuler& system);

inline constexpr double kRankTolerance = 1e-10;  ///< pivots that are smaller relative to the largest pivot count as 0
/// Solves the equations by complete orthogonal decomposition.
MinNormSolution min_norm_solution(const NewtonEuler& system);

/// Forces of the actuators in a solution, ordered by the indices of their joints [N, N m].
AxisVector<double> drive_forces(const NewtonEuler& system, const Eigen::VectorXd& solution);

/// A force component is determined if unit vectors of the null space change it by less than this tolerance.
inline constexpr double kUniqueTolerance = 1e-9;
/// Computes joint reactions and drive forces, as far as the equations determine them.
Reactions reactions(const NewtonEuler& system);

}  // namespace pkm
