// What a joint-space inertia M_q says of a mechanism: coupling indices of the joints, and its condition.
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

template <class S>
Vector<S, 4> coupling_indices(const Matrix<S, 4, 4>& M) {
  return {coupling_indices(
      JointInertia<S>{M(0, 0), M(1, 1), M(2, 2), M(3, 3), M(0, 1), M(0, 2), M(0, 3), M(1, 2), M(1, 3), M(2, 3)})};
}

/// The elements as a matrix.
template <class S>
Matrix<S, 4, 4> matrix_of(const JointInertia<S>& of) {
  Matrix<S, 4, 4> M;
  M.m = {of.m00, of.m01, of.m02, of.m03, of.m01, of.m11, of.m12, of.m13,
         of.m02, of.m12, of.m22, of.m23, of.m03, of.m13, of.m23, of.m33};
  return M;
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
