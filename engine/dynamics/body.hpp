// A rigid body whose motion the platform's pose determines, and what it adds to the equations of motion.
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"

namespace pkm {

/// Velocity and acceleration of its centre of mass: v = J_v Xdot, a = J_v Xddot + b_v, and of its turning:
/// omega = J_omega Xdot, epsilon = J_omega Xddot + b_omega.
template <class S, std::size_t N = 0>
struct Body {
  S mass{};                 ///< [kg]
  Matrix<S, 3, 3> inertia;  ///< about the centre of mass, along the world's axes [kg m^2]
  MatrixOf<S, 3, N ? N : kMostJoints, N != 0> J_v, J_omega;
  Vector<S, 3> b_v, b_omega;
};

/// Adds a body to M_X, h_X and G_X (virtual work): sum of m J_v^T J_v + J_omega^T I J_omega, and so on.
template <class S, std::size_t N>
void add_body(PoseDynamics<S, N>& d, const Body<S, N>& body, const std::type_identity_t<AxisVector<S, N>>& velocity) {
  const auto to_force = transpose(body.J_v), to_moment = transpose(body.J_omega);
  d.M_X += to_force * body.J_v * body.mass + to_moment * (body.inertia * body.J_omega);
  const Vector<S, 3> omega = body.J_omega * velocity;
  const Vector<S, 3> moment = body.inertia * body.b_omega + cross(omega, body.inertia * omega);
  d.h_X += to_force * (body.b_v * body.mass) + to_moment * moment;
  d.G_X += to_force * Vector<S, 3>{{S(0.0), S(0.0), body.mass * S(kGravity)}};
}

}  // namespace pkm
