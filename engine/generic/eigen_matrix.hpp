// Conversion of small matrices to Eigen.
#pragma once

#include <Eigen/Core>

#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// Matrix of bounded size, without heap allocation.
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

}  // namespace pkm::generic
