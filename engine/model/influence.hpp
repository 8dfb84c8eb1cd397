// Influence coefficients of a pose: speeds and accelerations of the joints for those of the platform, and back.
//
//   qdot = G Xdot,   qddot_i = G_i Xddot + Xdot^T H_i Xdot
//
// Solved for the platform, with F = G^-1: Xdot = F qdot, Xddot = F (qddot - Xdot^T H Xdot), so that the coefficients
// back are F and -sum_k F_ik F^T H_k F. G and H are the first and second derivatives of the joints by the pose.
#pragma once

#include <array>

#include "engine/math/small_matrix.hpp"

namespace pkm {

template <class S>
struct Influence {
  Matrix<S, 4, 4> G;
  std::array<Matrix<S, 4, 4>, 4> H;  ///< one symmetric matrix per joint
};

/// The terms Xdot^T H_i Xdot of the accelerations.
template <class S>
Vector<S, 4> velocity_terms(const Influence<S>& influence, const Vector<S, 4>& velocity) {
  Vector<S, 4> terms;
  for (std::size_t i = 0; i < 4; ++i) terms[i] = dot(velocity, influence.H[i] * velocity);
  return terms;
}

template <class S>
Vector<S, 4> accelerations(const Influence<S>& influence, const Vector<S, 4>& velocity,
                           const Vector<S, 4>& acceleration) {
  return influence.G * acceleration + velocity_terms(influence, velocity);
}

/// The matrices of quadratic forms, from their values form(v) at unit vectors and sums of two of them.
template <class Form>
std::array<Matrix<double, 4, 4>, 4> matrices_of(const Form& form) {
  std::array<Matrix<double, 4, 4>, 4> H;
  const auto unit = [](std::size_t j) {
    Vector<double, 4> v;
    v[j] = 1;
    return v;
  };
  for (std::size_t j = 0; j < 4; ++j) {
    const Vector<double, 4> terms = form(unit(j));
    for (std::size_t i = 0; i < 4; ++i) H[i](j, j) = terms[i];
  }
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t k = 0; k < j; ++k) {
      const Vector<double, 4> terms = form(unit(j) + unit(k));
      for (std::size_t i = 0; i < 4; ++i) H[i](j, k) = H[i](k, j) = (terms[i] - H[i](j, j) - H[i](k, k)) / 2;
    }
  return H;
}

/// The coefficients back. Infinite or NaN where G is singular.
template <class S>
Influence<S> reversed(const Influence<S>& influence) {
  Influence<S> back;
  const Matrix<S, 4, 4>& F = back.G = solve(influence.G, Matrix<S, 4, 4>::identity());
  for (std::size_t k = 0; k < 4; ++k) {
    const Matrix<S, 4, 4> seen = transpose(F) * influence.H[k] * F;
    for (std::size_t i = 0; i < 4; ++i) back.H[i] = back.H[i] - seen * F(i, k);
  }
  return back;
}

}  // namespace pkm
