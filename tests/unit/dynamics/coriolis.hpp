// Coriolis matrices: forces that are quadratic in the velocities as a matrix times the velocity.
//
//   C_X(i,j) = sum over k of (dM_X(i,j)/dX_k + dM_X(i,k)/dX_j - dM_X(j,k)/dX_i) Xdot_k / 2      (Christoffel symbols)
//   h_X = C_X Xdot,   C_q = J^-T (C_X - M_X J^-1 Jdot) J^-1,   c_q = C_q qdot
//
// Of all matrices that do this, these are the ones for which Mdot - 2 C is skew: what passivity arguments of
// controllers need. Derivatives by the pose come from a Dual4 evaluation at pose_variables().
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/dual.hpp"

namespace pkm {

/// A state whose pose carries the derivatives by x, y, z and the rotation, in this order.
inline MotionState<Dual4, 4> pose_variables(const MotionState<double, 4>& state) {
  const SchoenfliesPose<double>& at = state.pose;
  MotionState<Dual4, 4> s{
      {Dual4::variable(at.x, 0), Dual4::variable(at.y, 1), Dual4::variable(at.z, 2), Dual4::variable(at.angle, 3)}, {}};
  for (std::size_t k = 0; k < 4; ++k) s.velocity[k] = state.velocity[k];
  return s;
}

/// Values, without derivatives.
template <std::size_t R, std::size_t C>
Matrix<double, R, C> values(const Matrix<Dual4, R, C>& a) {
  Matrix<double, R, C> v;
  for (std::size_t k = 0; k < R * C; ++k) v.m[k] = a.m[k].a;
  return v;
}

/// d/dt of a matrix that depends on the pose alone; its derivatives are those by pose_variables().
template <std::size_t R, std::size_t C>
Matrix<double, R, C> rate(const Matrix<Dual4, R, C>& a, const Vector<double, 4>& velocity) {
  Matrix<double, R, C> sum;
  for (std::size_t e = 0; e < R * C; ++e)
    for (int k = 0; k < 4; ++k) sum.m[e] += a.m[e].v[k] * velocity[static_cast<std::size_t>(k)];
  return sum;
}

/// C_X in the coordinates X of the platform.
inline Matrix<double, 4, 4> coriolis_matrix(const Matrix<Dual4, 4, 4>& M_X, const Vector<double, 4>& velocity) {
  const auto slope = [&](std::size_t i, std::size_t j, std::size_t by) { return M_X(i, j).v[static_cast<int>(by)]; };
  Matrix<double, 4, 4> C_X;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        C_X(i, j) += (slope(i, j, k) + slope(i, k, j) - slope(j, k, i)) * velocity[k] * 0.5;
  return C_X;
}

/// C_q in the coordinates q of the joints; infinite where J is singular.
/// @param d  evaluated at pose_variables(); its velocity enters through `velocity` alone
inline Matrix<double, 4, 4> joint_coriolis_matrix(const PoseDynamics<Dual4, 4>& d, const Vector<double, 4>& velocity) {
  const Matrix<double, 4, 4> J = values(d.J);
  const Matrix<double, 4, 4> inner = coriolis_matrix(d.M_X, velocity) - values(d.M_X) * solve(J, rate(d.J, velocity));
  return transpose(solve(transpose(J), transpose(solve(transpose(J), inner))));
}

}  // namespace pkm
