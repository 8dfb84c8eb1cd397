// Indices of the joint-space inertia matrix M_q: dynamic coupling indices of the joints, and its inverse condition
// number.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "engine/dynamics/coupling_indices.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

/// Computes the dynamic coupling index of each joint from the joint-space inertia M_q.
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

/// Unit eigenvectors of the smallest and of the largest eigenvalue of a symmetric matrix.
struct ExtremeEigenvectors {
  static constexpr std::size_t kMax = 8;  ///< maximum number of rows of the matrix
  std::array<double, kMax> smallest{}, largest{};
};
/// Finds the unit eigenvectors of the smallest and of the largest eigenvalue of a symmetric matrix; std::nullopt if an
/// element is not finite.
/// @param elements n x n, row-major; n at most ExtremeEigenvectors::kMax
std::optional<ExtremeEigenvectors> extreme_eigenvectors(std::span<const double> elements, std::size_t n);

/// Inverse condition number of M_q: minimum over maximum eigenvalue, in [0, 1]; 1: all joints have the same inertia and
/// are decoupled; 0: M_q is singular or not finite. Derivatives of an eigenvalue: d lambda = v^T dM v.
template <SmallMatrix M>
typename M::Scalar inertia_condition(const M& M_q) {
  using S = typename M::Scalar;
  constexpr std::size_t kMax = ExtremeEigenvectors::kMax;
  static_assert(M::kRows <= kMax);
  const std::size_t n = M_q.rows();
  std::array<double, kMax * kMax> values{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) values[i * n + j] = value_of(M_q(i, j));
  const auto vectors = extreme_eigenvectors(std::span(values).first(n * n), n);
  if (!vectors) return S(0.0);
  const auto eigenvalue = [&](const std::array<double, kMax>& v) {  // v^T M v, with its derivatives
    S sum(0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) sum += M_q(i, j) * (v[i] * v[j]);
    return sum;
  };
  const S smallest = eigenvalue(vectors->smallest), largest = eigenvalue(vectors->largest);
  return value_of(largest) > 0 && value_of(smallest) > 0 ? S(smallest / largest) : S(0.0);
}

}  // namespace pkm
