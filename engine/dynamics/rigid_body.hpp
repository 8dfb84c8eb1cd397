// State of a rigid body at one instant: centre of mass, velocities, accelerations and applied forces.
#pragma once

#include <string>

#include "engine/math/small_matrix.hpp"

namespace pkm {

/// Inertia matrix of a point mass about a point from which it has the distance vector `offset` [kg m^2].
inline Matrix<double, 3, 3> point_inertia(double mass, const Vector<double, 3>& offset) {
  return (Matrix<double, 3, 3>::identity() * dot(offset, offset) - offset * transpose(offset)) * mass;
}

/// A rigid body and its state of motion. Vectors are in world axes.
struct RigidBody {
  std::string name;
  double mass = 0;               ///< mass [kg]
  Matrix<double, 3, 3> inertia;  ///< inertia matrix about the centre of mass [kg m^2]
  Vector<double, 3> centre;      ///< position of the centre of mass [m]
  Vector<double, 3> a;           ///< acceleration of the centre of mass [m/s^2]
  Vector<double, 3> omega;       ///< angular velocity [rad/s]
  Vector<double, 3> epsilon;     ///< angular acceleration [rad/s^2]
  Vector<double, 3> force;       ///< applied force, without weight [N]
  Vector<double, 3> moment;      ///< applied moment about the centre of mass [N m]
};

/// Adds a force and a moment that act on the body at a point in the world frame.
inline void apply(RigidBody& body, const Vector<double, 3>& point, const Vector<double, 3>& force,
                  const Vector<double, 3>& moment) {
  body.force += force;
  body.moment += moment + cross(point - body.centre, force);
}

}  // namespace pkm
