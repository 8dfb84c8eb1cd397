// Coriolis matrices: velocity-dependent forces as a matrix times the velocity, by Christoffel symbols.
//
//   C_X(i,j) = sum over k of (dM_X(i,j)/dX_k + dM_X(i,k)/dX_j - dM_X(j,k)/dX_i) Xdot_k / 2      (Christoffel symbols)
//   h_X = C_X Xdot,   C_q = J^-T (C_X - M_X J^-1 Jdot) J^-1,   c_q = C_q qdot
//
// Among all matrices with this property, the one of the Christoffel symbols makes Mdot - 2 C skew-symmetric, which
// passivity-based controllers rely on. Derivatives by the pose are computed by automatic differentiation at
// pose_variables(). Reference: Siciliano et al., "Robotics: Modelling, Planning and Control", 2009, section 7.2.
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/dual.hpp"

namespace pkm {

/// A state whose pose consists of derivative variables, at most four, in the order of the coordinates.
inline MotionState<Dual4> pose_variables(const MotionState<double>& state) {
  const std::size_t n = state.pose.size();
  MotionState<Dual4> s{Pose<Dual4>(n), AxisVector<Dual4>(n)};
  for (std::size_t k = 0; k < n; ++k) {
    s.pose[k] = Dual4::variable(state.pose[k], static_cast<int>(k));
    s.velocity[k] = Dual4(state.velocity[k]);
  }
  return s;
}

/// The values of a matrix, without derivatives.
inline AxisMatrix<double> values(const AxisMatrix<Dual4>& a) {
  AxisMatrix<double> v(a.rows(), a.cols());
  for (std::size_t k = 0; k < a.size(); ++k) v[k] = a[k].a;
  return v;
}

/// Time derivative of a matrix that depends on the pose only and was evaluated at pose_variables().
inline AxisMatrix<double> rate(const AxisMatrix<Dual4>& a, const AxisVector<double>& velocity) {
  AxisMatrix<double> sum(a.rows(), a.cols());
  for (std::size_t e = 0; e < a.size(); ++e)
    for (std::size_t k = 0; k < velocity.size(); ++k) sum[e] += a[e].v[static_cast<int>(k)] * velocity[k];
  return sum;
}

/// C_X in the coordinates X of the platform.
inline AxisMatrix<double> coriolis_matrix(const AxisMatrix<Dual4>& M_X, const AxisVector<double>& velocity) {
  const std::size_t n = velocity.size();
  const auto dM = [&](std::size_t i, std::size_t j, std::size_t by) { return M_X(i, j).v[static_cast<int>(by)]; };
  AxisMatrix<double> C_X(n, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) C_X(i, j) += (dM(i, j, k) + dM(i, k, j) - dM(j, k, i)) * velocity[k] * 0.5;
  return C_X;
}

/// C_q in the coordinates q of the joints; infinite if J is singular.
/// @param d  evaluated at pose_variables(); only its velocity-independent parts are used
inline AxisMatrix<double> joint_coriolis_matrix(const PoseDynamics<Dual4>& d, const AxisVector<double>& velocity) {
  const AxisMatrix<double> J = values(d.J);
  const AxisMatrix<double> inner = coriolis_matrix(d.M_X, velocity) - values(d.M_X) * solve(J, rate(d.J, velocity));
  return transpose(solve(transpose(J), transpose(solve(transpose(J), inner))));
}

}  // namespace pkm
