// Influence coefficients of a pose: speeds and accelerations of the joints for those of the platform, and back.
//
//   qdot = G Xdot,   qddot_i = G_i Xddot + Xdot^T H_i Xdot
//
// Solved for the platform, with F = G^-1: Xdot = F qdot, Xddot = F (qddot - Xdot^T H Xdot), so that the coefficients
// back are F and -sum_k F_ik F^T H_k F. G and H are the first and second derivatives of the joints by the pose.
#pragma once

#include <array>
#include <optional>

#include "engine/model/singular.hpp"

namespace pkm {

/// For N coordinates and as many joints; N = 0: for any number.
template <class S, std::size_t N = 0>
struct Influence {
  AxisMatrix<S, N> G;                                     ///< joints x coordinates
  std::array<AxisMatrix<S, N>, N ? N : kMostJoints> H{};  ///< one symmetric matrix per joint

  Influence() = default;
  /// Of a number known when compiling.
  template <std::size_t M>
  requires(N == 0 && M != 0) Influence(const Influence<S, M>& other) : G(other.G) {
    for (std::size_t i = 0; i < M; ++i) H[i] = other.H[i];
  }
};

template <class S, std::size_t N>
AxisVector<S, N> accelerations(const Influence<S, N>& influence, const AxisVector<S, N>& velocity,
                               const AxisVector<S, N>& acceleration) {
  AxisVector<S, N> joints = influence.G * acceleration;
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] += dot(velocity, influence.H[i] * velocity);
  return joints;
}

/// The matrices of quadratic forms, from their values form(v) at unit vectors and sums of two of them.
template <std::size_t N, class Form>
std::array<Matrix<double, N, N>, N> matrices_of(const Form& form) {
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

/// The coefficients back, where there are as many joints as coordinates. Infinite or NaN where G is singular.
template <class S, std::size_t N>
Influence<S, N> reversed(const Influence<S, N>& influence) {
  Influence<S, N> back;
  const std::size_t n = influence.G.rows();
  const AxisMatrix<S, N>& F = back.G = solve(influence.G, AxisMatrix<S, N>::identity(n));
  for (std::size_t i = 0; i < n; ++i) back.H[i] = AxisMatrix<S, N>::zero(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    const AxisMatrix<S, N> seen = transpose(F) * influence.H[k] * F;
    for (std::size_t i = 0; i < n; ++i) back.H[i] = back.H[i] - seen * F(i, k);
  }
  return back;
}

/// The Jacobian by the twist: K with qdot = K t for every twist t that the platform can have, so that K T = J. It is J
/// times the pseudo-inverse of T. None where angles have a singularity of their own: not every twist has rates.
/// @param J  joints x coordinates
/// @param T  6 x coordinates, t = T V
inline std::optional<AxisMatrix<double>> twist_jacobian(const AxisMatrix<double>& J, const AxisMatrix<double>& T) {
  if (is_rank_deficient(T)) return {};
  return J * solve(transpose(T) * T, transpose(T));
}

}  // namespace pkm
