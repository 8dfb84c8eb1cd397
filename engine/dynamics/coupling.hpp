// Dynamic coupling indices: how much of a joint's inertia force comes from the other joints.
//
//   DCI_i = 1 - exp(-delta_i),   delta_i = sum over k != i of |M_q(i,k)| / |M_q(i,i)|
//
// 0: none; tends to 1. Free of units, because all entries of M_q are in kg. Source: as pose_dynamics.hpp, eq 42.
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/math/dual.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

template <class S>
Vector<S, 4> coupling_indices(const Matrix<S, 4, 4>& M) {
  const S m01 = magnitude(M(0, 1)), m02 = magnitude(M(0, 2)), m03 = magnitude(M(0, 3)), m12 = magnitude(M(1, 2)),
          m13 = magnitude(M(1, 3)), m23 = magnitude(M(2, 3));
  const std::array<S, 4> off = {m01 + m02 + m03, m01 + m12 + m13, m02 + m12 + m23, m03 + m13 + m23};
  Vector<S, 4> index;
  for (std::size_t i = 0; i < 4; ++i) index[i] = S(1.0) - exp(S(off[i] / M(i, i) * -1.0));
  return index;
}

/// Least over greatest eigenvalue of M_q, in [0, 1]: 1 where every joint feels the same inertia and none couples.
/// With derivatives d lambda = v^T dM v.
template <class S>
S inertia_condition(const Matrix<S, 4, 4>& M) {
  Eigen::Matrix4d values;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) values(i, j) = value_of(M(static_cast<std::size_t>(i), static_cast<std::size_t>(j)));
  if (!values.allFinite()) return S(0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(values);
  const auto along = [&](int which) {
    S sum(0.0);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        sum += M(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) *
               (eigen.eigenvectors()(i, which) * eigen.eigenvectors()(j, which));
    return sum;
  };
  const S least = along(0), greatest = along(3);
  return value_of(greatest) > 0 && value_of(least) > 0 ? S(least / greatest) : S(0.0);
}

}  // namespace pkm
