// First- and second-order kinematic influence coefficients of a pose: they map velocities and accelerations of the
// platform to those of the joints, and vice versa.
//
//   qdot = G Xdot,   qddot_i = G_i Xddot + Xdot^T H_i Xdot
//
// G (joints x coordinates) and H (one matrix per joint) are the first and second derivatives of the joint positions
// with respect to the pose. Solving for the platform with F = G^-1 gives Xdot = F qdot and
// Xddot = F (qddot - Xdot^T H Xdot), so the coefficients of the inverse map are F and -sum_k F_ik F^T H_k F.
//
// Reference: Thomas, Tesar, "Dynamic modeling of serial manipulator arms", J. Dyn. Syst. Meas. Control 104 (1982).
#pragma once

#include <array>
#include <optional>

#include "engine/geometry/singular.hpp"

namespace pkm {

template <class S>
struct Influence {
  AxisMatrix<S> G;  ///< joints x coordinates: dq_i/dX_j
  /// For each joint i, the symmetric matrix of second derivatives d2q_i/(dX_j dX_k).
  std::array<AxisMatrix<S>, kMaxJoints> H{};
};

/// Accelerations qddot of the joints for a motion of the platform.
/// @param velocity, acceleration  rates Xdot and accelerations Xddot of the pose coordinates
template <class S>
AxisVector<S> accelerations(const Influence<S>& influence, const AxisVector<S>& velocity,
                            const AxisVector<S>& acceleration) {
  AxisVector<S> joints = influence.G * acceleration;
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] += dot(velocity, influence.H[i] * velocity);
  return joints;
}

/// The symmetric n x n matrices of several quadratic forms, from the values of the forms at the unit vectors and at
/// sums of two unit vectors (polarisation).
/// @param form  form(v): values at v of all forms; at most kMaxJoints
template <class Form>
std::array<AxisMatrix<double>, kMaxJoints> quadratic_form_matrices(std::size_t n, const Form& form) {
  std::array<AxisMatrix<double>, kMaxJoints> H;
  H.fill(AxisMatrix<double>(n, n));
  AxisVector<double> v(n);
  for (std::size_t j = 0; j < n; ++j) {
    v[j] = 1;
    const AxisVector<double> squares = form(v);
    for (std::size_t i = 0; i < squares.size(); ++i) H[i](j, j) = squares[i];
    for (std::size_t k = 0; k < j; ++k) {
      v[k] = 1;
      const AxisVector<double> sums = form(v);
      v[k] = 0;
      for (std::size_t i = 0; i < sums.size(); ++i) H[i](j, k) = H[i](k, j) = (sums[i] - H[i](j, j) - H[i](k, k)) / 2;
    }
    v[j] = 0;
  }
  return H;
}

/// The influence coefficients of the inverse map, from the joints to the platform; G must be square. Infinite or NaN if
/// G is singular.
template <class S>
Influence<S> reversed(const Influence<S>& influence) {
  Influence<S> back;
  const std::size_t n = influence.G.rows();
  const AxisMatrix<S>& F = back.G = solve(influence.G, AxisMatrix<S>::identity(n));
  for (std::size_t i = 0; i < n; ++i) back.H[i] = AxisMatrix<S>::zero(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    const AxisMatrix<S> FHF = transpose(F) * influence.H[k] * F;
    for (std::size_t i = 0; i < n; ++i) back.H[i] = back.H[i] - FHF * F(i, k);
  }
  return back;
}

/// The Jacobian K = J T^+ with respect to the twist of the platform: qdot = K t for every feasible twist t (T^+ is the
/// pseudo-inverse, so K T = J).
/// @param J  joints x coordinates, qdot = J V for the rates V of the coordinates
/// @param T  6 x coordinates, t = T V
/// @return joints x 6; std::nullopt at a singularity of the angle coordinates, where T is rank deficient
inline std::optional<AxisMatrix<double>> twist_jacobian(const AxisMatrix<double>& J, const AxisMatrix<double>& T) {
  if (is_rank_deficient(T)) return {};
  return J * solve(transpose(T) * T, transpose(T));
}

}  // namespace pkm
