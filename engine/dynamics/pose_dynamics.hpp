// The equations of motion of one pose, in the coordinates X of the platform and in those q of the joints.
//
//   J^T tau = M_X Xddot + h_X + G_X - W_X,   qdot = J Xdot,   W_X = J_w^T (F, M)
//   tau     = M_q qddot + c_q + G_q - J^-T W_X,   M_q = J^-T M_X J^-1,   c_q = J^-T (h_X - M_X J^-1 Jdot Xdot)
//
// Source: virtual work with the bodies' Jacobians; Transactions of the Chinese Society for Agricultural Machinery 54
// (9), 2023, 448-458, eqs 36 to 41, with its errata. A mechanism fills PoseDynamics in; the rest is here.
#pragma once

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/math/small_matrix.hpp"
#include "engine/model/pose.hpp"
#include "engine/model/singular.hpp"

namespace pkm {

inline constexpr double kGravity = 9.81;  ///< [m/s^2], along -z

/// Force and moment on the platform [N, N m]: Fx, Fy, Fz, Mx, My, Mz.
template <class S>
using Wrench = Vector<S, 6>;

inline const std::vector<std::string>& wrench_names() {
  static const std::vector<std::string> names = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  return names;
}

/// A pose on its way: what the equations of motion are evaluated at. N as in PoseDynamics.
template <class S, std::size_t N = 0>
struct MotionState {
  Pose<S> pose;
  AxisVector<S> velocity;  ///< Xdot [m/s, rad/s]

  operator MotionState<S, 4>() const { return {schoenflies(pose), fixed<4>(velocity)}; }
};
template <class S>
struct MotionState<S, 4> {
  SchoenfliesPose<S> pose;
  Vector<S, 4> velocity;
};

/// For N coordinates and as many joints; N = 0: for any number of both.
template <class S, std::size_t N = 0>
struct PoseDynamics {
  using Vec = AxisVector<S, N>;
  using Mat = AxisMatrix<S, N>;
  bool assembles = false;  ///< false: nothing below is set
  Vec q;                   ///< joint positions [m, rad]
  Mat J;                   ///< qdot = J Xdot
  Vec J_rate_X;            ///< Jdot Xdot
  Mat M_X;                 ///< inertia, kinetic energy = Xdot^T M_X Xdot / 2
  Vec h_X;                 ///< centrifugal and Coriolis terms at the velocity given
  Vec G_X;                 ///< weight: gradient of the potential energy
  /// Velocity and angular velocity of the point where a wrench acts.
  MatrixOf<S, 6, N ? N : kMostJoints, N != 0> J_wrench;

  operator PoseDynamics<S>() const requires(N != 0) { return {assembles, q, J, J_rate_X, M_X, h_X, G_X, J_wrench}; }
};

/// Joint-space form; NaN where J is singular to working precision.
template <class S, std::size_t N = 0>
struct JointSpace {
  AxisMatrix<S, N> M_q;       ///< [kg]
  AxisVector<S, N> c_q, G_q;  ///< Coriolis and centrifugal forces, weight [N]
};

/// The same size, and NaN everywhere: what does not exist where J is singular.
template <SmallMatrix M>
M undetermined(M like) {
  for (auto& element : like) element = typename M::Scalar(std::numeric_limits<double>::quiet_NaN());
  return like;
}

/// J^-T f; NaN where J is singular to working precision.
template <class S, std::size_t N>
AxisVector<S, N> at_joints(const PoseDynamics<S, N>& d, const AxisVector<S, N>& f) {
  auto eliminated = transpose(d.J);
  auto forces = f;
  eliminate(eliminated, forces);
  if (is_singular(d.J, eliminated)) return undetermined(f);
  substitute_back(eliminated, forces);
  return forces;
}

/// Forces tau of the actuators for an acceleration Xddot under a wrench on the platform, by virtual work [N]; NaN where
/// J is singular to working precision.
template <class S, std::size_t N>
AxisVector<S, N> drive_forces(const PoseDynamics<S, N>& d, const std::type_identity_t<AxisVector<S, N>>& acceleration,
                              const Wrench<S>& wrench) {
  return at_joints<S, N>(d, d.M_X * acceleration + d.h_X + d.G_X - transpose(d.J_wrench) * wrench);
}

/// Inertia as the joints feel it [kg]; symmetric to the last bit. NaN where J is singular to working precision.
template <class S, std::size_t N>
AxisMatrix<S, N> joint_inertia(const PoseDynamics<S, N>& d) {
  auto eliminated = transpose(d.J);
  AxisMatrix<S, N> half = d.M_X;
  eliminate(eliminated, half);
  if (is_singular(d.J, eliminated)) return undetermined(d.M_X);
  substitute_back(eliminated, half);                            // J^-T M_X
  AxisMatrix<S, N> M = solve(transpose(d.J), transpose(half));  // J^-T (J^-T M_X)^T
  for (std::size_t i = 0; i < M.rows(); ++i)
    for (std::size_t j = 0; j < i; ++j) M(i, j) = M(j, i) = (M(i, j) + M(j, i)) * S(0.5);
  return M;
}

template <class S, std::size_t N>
JointSpace<S, N> joint_space(const PoseDynamics<S, N>& d) {
  return {joint_inertia(d), at_joints<S, N>(d, d.h_X - d.M_X * solve(d.J, d.J_rate_X)), at_joints<S, N>(d, d.G_X)};
}

/// Acceleration Xddot under forces of the actuators and a wrench on the platform (forward dynamics).
template <class S, std::size_t N>
AxisVector<S, N> acceleration(const PoseDynamics<S, N>& d, const std::type_identity_t<AxisVector<S, N>>& tau,
                              const Wrench<S>& wrench) {
  return solve(d.M_X, transpose(d.J) * tau + transpose(d.J_wrench) * wrench - d.h_X - d.G_X);
}

/// Kinetic energy [J].
template <class S, std::size_t N>
S kinetic_energy(const PoseDynamics<S, N>& d, const std::type_identity_t<AxisVector<S, N>>& velocity) {
  return dot(velocity, d.M_X * velocity) * S(0.5);
}

}  // namespace pkm
