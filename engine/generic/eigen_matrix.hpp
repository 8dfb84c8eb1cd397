// Conversion of small matrices to Eigen, and back.
#pragma once

#include <Eigen/Core>

#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// Eigen matrix of at most kMaxJoints rows and columns, without heap allocation.
using EigenMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

/// The values of A, without derivatives.
template <SmallMatrix M>
EigenMatrix eigen(const M& A) {
  EigenMatrix copy(A.rows(), A.cols());
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.cols(); ++j)
      copy(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value_of(A(i, j));
  return copy;
}

/// Conversion from an Eigen matrix of at most kMaxJoints rows and columns.
template <class Derived>
AxisMatrix<double> axis_matrix(const Eigen::MatrixBase<Derived>& A) {
  AxisMatrix<double> copy(static_cast<std::size_t>(A.rows()), static_cast<std::size_t>(A.cols()));
  for (std::size_t i = 0; i < copy.rows(); ++i)
    for (std::size_t j = 0; j < copy.cols(); ++j)
      copy(i, j) = A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return copy;
}

}  // namespace pkm::generic
