// Indices of the joint-space inertia matrix M_q: dynamic coupling indices of the joints, and its inverse condition
// number.
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

/// The dynamic coupling index of each joint.
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

/// Converts the elements of M_q to a 4 x 4 matrix.
template <class S>
Matrix<S, 4, 4> matrix_of(const JointInertia<S>& elements) {
  Matrix<S, 4, 4> M;
  M.m = {elements.m00, elements.m01, elements.m02, elements.m03, elements.m01, elements.m11,
         elements.m12, elements.m13, elements.m02, elements.m12, elements.m22, elements.m23,
         elements.m03, elements.m13, elements.m23, elements.m33};
  return M;
}

/// Inverse condition number of M_q: minimum over maximum eigenvalue, in [0, 1]; 1: all joints have the same inertia and
/// are decoupled; 0: M_q is singular or not finite. Derivatives of an eigenvalue: d lambda = v^T dM v.
template <SmallMatrix M>
typename M::Scalar inertia_condition(const M& M_q) {
  using S = typename M::Scalar;
  if constexpr (!M::kFixed)
    if (M_q.rows() == 4) return inertia_condition(fixed<4, 4>(M_q));  // the same bits as with the fixed size
  constexpr int kMax = static_cast<int>(M::kRows), kSize = M::kFixed ? kMax : Eigen::Dynamic;
  using Values = Eigen::Matrix<double, kSize, kSize, 0, kMax, kMax>;
  const auto n = static_cast<int>(M_q.rows());
  const auto element = [&](int i, int j) { return M_q(static_cast<std::size_t>(i), static_cast<std::size_t>(j)); };
  Values values(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) values(i, j) = value_of(element(i, j));
  if (!values.allFinite()) return S(0.0);
  const Eigen::SelfAdjointEigenSolver<Values> eigen(values);
  const auto eigenvalue = [&](int which) {  // v^T M v, whose derivatives are those of the eigenvalue
    S sum(0.0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += element(i, j) * (eigen.eigenvectors()(i, which) * eigen.eigenvectors()(j, which));
    return sum;
  };
  const S smallest = eigenvalue(0), largest = eigenvalue(n - 1);
  return value_of(largest) > 0 && value_of(smallest) > 0 ? S(smallest / largest) : S(0.0);
}

}  // namespace pkm
