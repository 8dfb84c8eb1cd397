// What a joint-space inertia M_q says of a mechanism: coupling indices of the joints, and its condition.
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

/// Of each joint, from M_q.
template <SmallMatrix M>
auto coupling_indices(const M& M_q) {
  using S = typename M::Scalar;
  auto indices = MatrixOf<S, M::kRows, 1, M::kFixed>::zero(M_q.rows(), 1);
  for (std::size_t i = 0; i < M_q.rows(); ++i) {
    S off(0.0);
    for (std::size_t k = 0; k < M_q.rows(); ++k)
      if (k != i) off = off + magnitude(M_q(i, k));
    indices[i] = coupling_index(off, M_q(i, i));
  }
  return indices;
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
template <SmallMatrix M>
typename M::Scalar inertia_condition(const M& M_q) {
  using S = typename M::Scalar;
  if constexpr (!M::kFixed)
    if (M_q.rows() == 4) return inertia_condition(fixed<4, 4>(M_q));  // the same bits as where 4 is known
  constexpr int kMost = static_cast<int>(M::kRows), kSize = M::kFixed ? kMost : Eigen::Dynamic;
  using Values = Eigen::Matrix<double, kSize, kSize, 0, kMost, kMost>;
  const auto n = static_cast<int>(M_q.rows());
  const auto element = [&](int i, int j) { return M_q(static_cast<std::size_t>(i), static_cast<std::size_t>(j)); };
  Values values(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) values(i, j) = value_of(element(i, j));
  if (!values.allFinite()) return S(0.0);
  const Eigen::SelfAdjointEigenSolver<Values> eigen(values);
  const auto along = [&](int which) {
    S sum(0.0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += element(i, j) * (eigen.eigenvectors()(i, which) * eigen.eigenvectors()(j, which));
    return sum;
  };
  const S least = along(0), greatest = along(n - 1);
  return value_of(greatest) > 0 && value_of(least) > 0 ? S(least / greatest) : S(0.0);
}

}  // namespace pkm
