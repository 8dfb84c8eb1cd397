// First- and second-order kinematic influence coefficients of a pose: they map velocities and accelerations of the
// platform to those of the joints, and vice versa.
//
//   qdot = G Xdot,   qddot_i = G_i Xddot + Xdot^T H_i Xdot
//
// G (joints x coordinates) and H (one matrix per joint) are the first and second derivatives of the joint positions by
// the pose. Solving for the platform with F = G^-1 gives Xdot = F qdot and Xddot = F (qddot - Xdot^T H Xdot), so the
// coefficients of the inverse map are F and -sum_k F_ik F^T H_k F.
//
// Reference: Thomas, Tesar, "Dynamic modeling of serial manipulator arms", J. Dyn. Syst. Meas. Control 104 (1982).
#pragma once

#include <array>
#include <optional>

#include "engine/geometry/singular.hpp"

namespace pkm {

/// For N coordinates and N joints; N = 0: numbers known at run time only.
template <class S, std::size_t N = 0>
struct Influence {
  AxisMatrix<S, N> G;                                    ///< joints x coordinates
  std::array<AxisMatrix<S, N>, N ? N : kMaxJoints> H{};  ///< one symmetric matrix per joint

  Influence() = default;
  /// Converts from a fixed size.
  template <std::size_t M>
  requires(N == 0 && M != 0) Influence(const Influence<S, M>& other) : G(other.G) {
    for (std::size_t i = 0; i < M; ++i) H[i] = other.H[i];
  }
};

/// Accelerations qddot of the joints.
/// @param velocity, acceleration  Xdot and Xddot of the platform
template <class S, std::size_t N>
AxisVector<S, N> accelerations(const Influence<S, N>& influence, const AxisVector<S, N>& velocity,
                               const AxisVector<S, N>& acceleration) {
  AxisVector<S, N> joints = influence.G * acceleration;
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] += dot(velocity, influence.H[i] * velocity);
  return joints;
}

/// The symmetric matrices of N quadratic forms, from their values at the unit vectors and at sums of two unit vectors
/// (polarisation).
/// @param form  form(v): the values of the N forms at v
template <std::size_t N, class Form>
std::array<Matrix<double, N, N>, N> quadratic_form_matrices(const Form& form) {
  std::array<Matrix<double, N, N>, N> H;
  const auto unit = [](std::size_t j) {
    Vector<double, N> v;
    v[j] = 1;
    return v;
  };
  for (std::size_t j = 0; j < N; ++j) {
    const Vector<double, N> terms = form(unit(j));
    for (std::size_t i = 0; i < N; ++i) H[i](j, j) = terms[i];
  }
  for (std::size_t j = 0; j < N; ++j)
    for (std::size_t k = 0; k < j; ++k) {
      const Vector<double, N> terms = form(unit(j) + unit(k));
      for (std::size_t i = 0; i < N; ++i) H[i](j, k) = H[i](k, j) = (terms[i] - H[i](j, j) - H[i](k, k)) / 2;
    }
  return H;
}

/// The influence coefficients of the inverse map, from the joints to the platform; G must be square. Infinite or NaN if
/// G is singular.
template <class S, std::size_t N>
Influence<S, N> reversed(const Influence<S, N>& influence) {
  Influence<S, N> back;
  const std::size_t n = influence.G.rows();
  const AxisMatrix<S, N>& F = back.G = solve(influence.G, AxisMatrix<S, N>::identity(n));
  for (std::size_t i = 0; i < n; ++i) back.H[i] = AxisMatrix<S, N>::zero(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    const AxisMatrix<S, N> FHF = transpose(F) * influence.H[k] * F;
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
