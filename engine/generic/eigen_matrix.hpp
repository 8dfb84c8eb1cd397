// Small matrices as Eigen's.
#pragma once

#include <Eigen/Core>

#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// Allocates nothing.
using EigenMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

/// The values.
template <SmallMatrix M>
EigenMatrix eigen(const M& A) {
  EigenMatrix same(A.rows(), A.cols());
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.cols(); ++j)
      same(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value_of(A(i, j));
  return same;
}

}  // namespace pkm::generic
