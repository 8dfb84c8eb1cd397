// Equations of motion at one pose, in the coordinates X of the platform (task space) and in those of the joints q
// (joint space).
//
//   J^T tau = M_X Xddot + h_X + G_X - W_X,   qdot = J Xdot,   W_X = J_w^T (F, M)
//   tau     = M_q qddot + c_q + G_q - J^-T W_X,   M_q = J^-T M_X J^-1,   c_q = J^-T (h_X - M_X J^-1 Jdot Xdot)
//
// Derived by the principle of virtual work with the Jacobians of the bodies. Source: Transactions of the Chinese
// Society for Agricultural Machinery 54 (9), 2023, 448-458, eqs 36 to 41, with its errata. A mechanism provides
// PoseDynamics; the functions below derive forces, joint-space inertia and accelerations from it.
#pragma once

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/geometry/pose.hpp"
#include "engine/geometry/singular.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

inline constexpr double kGravity = 9.81;  ///< gravitational acceleration along -z [m/s^2]

/// External force and moment on the platform [N, N m]: Fx, Fy, Fz, Mx, My, Mz.
template <class S>
using Wrench = Vector<S, 6>;

inline const std::vector<std::string>& wrench_names() {
  static const std::vector<std::string> names = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  return names;
}

/// The pose and the velocity of the platform at which the equations of motion are evaluated.
template <class S>
struct MotionState {
  Pose<S> pose;
  AxisVector<S> velocity;  ///< Xdot: rates of the platform coordinates [m/s, rad/s]
};

/// The equations of motion in the coordinates of the platform.
template <class S>
struct PoseDynamics {
  /// False: the mechanism cannot be assembled at the pose, and the members below are not set.
  bool assembles = false;
  AxisVector<S> q;         ///< joint positions [m, rad]
  AxisMatrix<S> J;         ///< Jacobian, joints x coordinates: qdot = J Xdot
  AxisVector<S> J_rate_X;  ///< product Jdot Xdot, the joint accelerations for Xddot = 0
  AxisMatrix<S> M_X;       ///< inertia matrix: kinetic energy = Xdot^T M_X Xdot / 2
  AxisVector<S> h_X;       ///< centrifugal and Coriolis forces at the velocity of the state
  AxisVector<S> G_X;       ///< gravity forces: gradient of the potential energy with respect to X
  /// Jacobian J_w of the point where a wrench acts: its velocity and angular velocity are J_w Xdot.
  MatrixUpTo<S, 6, kMaxJoints> J_wrench;
};

/// The equations of motion in joint space; NaN if J is singular to working precision.
template <class S>
struct JointSpace {
  AxisMatrix<S> M_q;       ///< inertia matrix [kg, kg m, kg m^2]
  AxisVector<S> c_q, G_q;  ///< Coriolis and centrifugal forces; gravity forces [N, N m]
};

/// Returns a matrix of the size of `like` whose elements are NaN. It stands for quantities that do not exist at
/// singularities.
template <SmallMatrix M>
M undetermined(M like) {
  for (auto& element : like) element = typename M::Scalar(std::numeric_limits<double>::quiet_NaN());
  return like;
}

/// Joint forces J^-T f that are equivalent to forces f in the coordinates of the platform; NaN if J is singular to
/// working precision.
template <class S>
AxisVector<S> at_joints(const PoseDynamics<S>& d, const AxisVector<S>& f) {
  auto eliminated = transpose(d.J);
  auto forces = f;
  eliminate(eliminated, forces);
  if (is_singular(d.J, eliminated)) return undetermined(f);
  substitute_back(eliminated, forces);
  return forces;
}

/// Inverse dynamics: forces tau of the actuators that produce an acceleration Xddot under a wrench on the platform [N,
/// N m]; NaN if J is singular to working precision.
template <class S>
AxisVector<S> drive_forces(const PoseDynamics<S>& d, const std::type_identity_t<AxisVector<S>>& acceleration,
                           const Wrench<S>& wrench) {
  return at_joints<S>(d, d.M_X * acceleration + d.h_X + d.G_X - transpose(d.J_wrench) * wrench);
}

/// Joint-space inertia matrix M_q [kg, kg m, kg m^2], exactly symmetric. NaN if J is singular to working precision.
template <class S>
AxisMatrix<S> joint_inertia(const PoseDynamics<S>& d) {
  auto eliminated = transpose(d.J);
  AxisMatrix<S> half = d.M_X;
  eliminate(eliminated, half);
  if (is_singular(d.J, eliminated)) return undetermined(d.M_X);
  substitute_back(eliminated, half);                         // J^-T M_X
  AxisMatrix<S> M = solve(transpose(d.J), transpose(half));  // J^-T (J^-T M_X)^T
  for (std::size_t i = 0; i < M.rows(); ++i)
    for (std::size_t j = 0; j < i; ++j) M(i, j) = M(j, i) = (M(i, j) + M(j, i)) * S(0.5);
  return M;
}

/// Transforms the equations of motion from the platform coordinates to joint space.
template <class S>
JointSpace<S> joint_space(const PoseDynamics<S>& d) {
  return {joint_inertia(d), at_joints<S>(d, d.h_X - d.M_X * solve(d.J, d.J_rate_X)), at_joints<S>(d, d.G_X)};
}

/// Forward dynamics: acceleration Xddot under forces tau of the actuators and a wrench on the platform.
template <class S>
AxisVector<S> acceleration(const PoseDynamics<S>& d, const std::type_identity_t<AxisVector<S>>& tau,
                           const Wrench<S>& wrench) {
  return solve(d.M_X, transpose(d.J) * tau + transpose(d.J_wrench) * wrench - d.h_X - d.G_X);
}

/// Kinetic energy of the mechanism [J].
template <class S>
S kinetic_energy(const PoseDynamics<S>& d, const std::type_identity_t<AxisVector<S>>& velocity) {
  return dot(velocity, d.M_X * velocity) * S(0.5);
}

}  // namespace pkm
