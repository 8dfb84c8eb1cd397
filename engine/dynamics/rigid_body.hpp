// A rigid body at one instant: where its centre of mass is, how it moves and what acts on it.
#pragma once

#include <string>

#include "engine/dynamics/body.hpp"

namespace pkm {

/// A body with its name and the place of its centre of mass.
template <std::size_t N = 0>
struct PlacedBody {
  std::string name;          ///< "rod 11"
  Vector<double, 3> centre;  ///< of mass, in the world [m]
  Body<double, N> body;
};

/// I of a point mass at `offset` from the point it is taken about [kg m^2].
inline Matrix<double, 3, 3> point_inertia(double mass, const Vector<double, 3>& offset) {
  return (Matrix<double, 3, 3>::identity() * dot(offset, offset) - offset * transpose(offset)) * mass;
}

/// Two bodies that turn together as one, called `name`: the centre of mass of both, inertia by parallel axes.
template <std::size_t N>
PlacedBody<N> unite(const std::string& name, const PlacedBody<N>& a, const PlacedBody<N>& b) {
  PlacedBody<N> both{name, {}, a.body};
  both.body.mass = a.body.mass + b.body.mass;
  const double of_a = a.body.mass / both.body.mass, of_b = b.body.mass / both.body.mass;
  both.centre = a.centre * of_a + b.centre * of_b;
  both.body.J_v = a.body.J_v * of_a + b.body.J_v * of_b;
  both.body.b_v = a.body.b_v * of_a + b.body.b_v * of_b;
  both.body.inertia = a.body.inertia + point_inertia(a.body.mass, a.centre - both.centre) + b.body.inertia +
                      point_inertia(b.body.mass, b.centre - both.centre);
  return both;
}

/// In motion, world axes.
struct RigidBody {
  std::string name;
  double mass = 0;               ///< [kg]
  Matrix<double, 3, 3> inertia;  ///< about the centre of mass [kg m^2]
  Vector<double, 3> centre;      ///< of mass [m]
  Vector<double, 3> a;           ///< its acceleration [m/s^2]
  Vector<double, 3> omega;       ///< angular velocity [rad/s]
  Vector<double, 3> epsilon;     ///< angular acceleration [rad/s^2]
  Vector<double, 3> force;       ///< from outside, besides weight [N]
  Vector<double, 3> moment;      ///< from outside, about the centre of mass [N m]
};

/// @param velocity, acceleration  Xdot and Xddot of the platform
template <std::size_t N>
RigidBody in_motion(const PlacedBody<N>& placed, const std::type_identity_t<AxisVector<double, N>>& velocity,
                    const std::type_identity_t<AxisVector<double, N>>& acceleration) {
  const Body<double, N>& b = placed.body;
  return {.name = placed.name,
          .mass = b.mass,
          .inertia = b.inertia,
          .centre = placed.centre,
          .a = b.J_v * acceleration + b.b_v,
          .omega = b.J_omega * velocity,
          .epsilon = b.J_omega * acceleration + b.b_omega,
          .force = {},
          .moment = {}};
}

/// Lets a force and a moment act on the body at a point of the world.
inline void apply(RigidBody& body, const Vector<double, 3>& point, const Vector<double, 3>& force,
                  const Vector<double, 3>& moment) {
  body.force += force;
  body.moment += moment + cross(point - body.centre, force);
}

}  // namespace pkm
