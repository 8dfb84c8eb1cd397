// The equations of motion of one pose, in the coordinates X of the platform and in those q of the joints.
//
//   J^T tau = M_X Xddot + h_X + G_X - W_X,   qdot = J Xdot,   W_X = J_w^T (F, M)
//   tau     = M_q qddot + c_q + G_q - J^-T W_X,   M_q = J^-T M_X J^-1,   c_q = J^-T (h_X - M_X J^-1 Jdot Xdot)
//
// Source: virtual work with the bodies' Jacobians; Transactions of the Chinese Society for Agricultural Machinery 54
// (9), 2023, 448-458, eqs 36 to 41, with its errata. A mechanism fills PoseDynamics in; the rest is here.
#pragma once

#include <string>
#include <vector>

#include "engine/math/small_matrix.hpp"
#include "engine/model/pose.hpp"

namespace pkm {

inline constexpr double kGravity = 9.81;  ///< [m/s^2], along -z

/// Force and moment on the platform [N, N m]: Fx, Fy, Fz, Mx, My, Mz.
template <class S>
using Wrench = Vector<S, 6>;

inline const std::vector<std::string>& wrench_names() {
  static const std::vector<std::string> names = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  return names;
}

/// A pose on its way: what the equations of motion are evaluated at.
template <class S>
struct MotionState {
  Pose<S> pose;
  Vector<S, 4> velocity;  ///< Xdot [m/s, rad/s]
};

template <class S>
struct PoseDynamics {
  bool assembles = false;    ///< false: nothing below is set
  Vector<S, 4> q;            ///< joint positions [m]
  Matrix<S, 4, 4> J;         ///< qdot = J Xdot
  Vector<S, 4> J_rate_X;     ///< Jdot Xdot
  Matrix<S, 4, 4> M_X;       ///< inertia, kinetic energy = Xdot^T M_X Xdot / 2
  Vector<S, 4> h_X;          ///< centrifugal and Coriolis terms at the velocity given
  Vector<S, 4> G_X;          ///< weight: gradient of the potential energy
  Matrix<S, 6, 4> J_wrench;  ///< velocity and angular velocity of the point where a wrench acts
};

/// Joint-space form; infinite where J is singular.
template <class S>
struct JointSpace {
  Matrix<S, 4, 4> M_q;    ///< [kg]
  Vector<S, 4> c_q, G_q;  ///< Coriolis and centrifugal forces, weight [N]
};

/// J^-T f.
template <class S>
Vector<S, 4> at_joints(const PoseDynamics<S>& d, const Vector<S, 4>& f) {
  return solve(transpose(d.J), f);
}

/// Forces tau of the actuators for an acceleration Xddot under a wrench on the platform, by virtual work [N].
template <class S>
Vector<S, 4> drive_forces(const PoseDynamics<S>& d, const Vector<S, 4>& acceleration, const Wrench<S>& wrench) {
  return at_joints(d, d.M_X * acceleration + d.h_X + d.G_X - transpose(d.J_wrench) * wrench);
}

/// Inertia as the joints feel it [kg]; symmetric to the last bit.
template <class S>
Matrix<S, 4, 4> joint_inertia(const PoseDynamics<S>& d) {
  const Matrix<S, 4, 4> half = solve(transpose(d.J), d.M_X);   // J^-T M_X
  Matrix<S, 4, 4> M = solve(transpose(d.J), transpose(half));  // J^-T (J^-T M_X)^T
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) M(i, j) = M(j, i) = (M(i, j) + M(j, i)) * S(0.5);
  return M;
}

template <class S>
JointSpace<S> joint_space(const PoseDynamics<S>& d) {
  return {joint_inertia(d), at_joints(d, d.h_X - d.M_X * solve(d.J, d.J_rate_X)), at_joints(d, d.G_X)};
}

/// Acceleration Xddot under forces of the actuators and a wrench on the platform (forward dynamics).
template <class S>
Vector<S, 4> acceleration(const PoseDynamics<S>& d, const Vector<S, 4>& tau, const Wrench<S>& wrench) {
  return solve(d.M_X, transpose(d.J) * tau + transpose(d.J_wrench) * wrench - d.h_X - d.G_X);
}

/// Kinetic energy [J].
template <class S>
S kinetic_energy(const PoseDynamics<S>& d, const Vector<S, 4>& velocity) {
  return dot(velocity, d.M_X * velocity) * S(0.5);
}

}  // namespace pkm
