// Side of the singularities on which a pose lies, from its Jacobian.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/mechanism/abilities/columns.hpp"

namespace pkm {

/// The sign of det J by Gaussian elimination with partial pivoting. J is singular to working precision if a pivot is
/// less than 1e-12 of the largest element of its row of J, or if an element is not finite.
/// @param J  joints x coordinates; if it has more rows than columns, det J is undefined, and its singularities, where
///           det(J^T J) = 0, separate no poses
inline std::int8_t side_of(AxisMatrix<double> J) {
  constexpr double kMinPivot = 1e-12;
  const std::size_t n = J.rows();
  if (n != J.cols()) return PoseSides::kPositive;
  AxisVector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (!std::isfinite(J(i, j))) return PoseSides::kSingular;
      scale[i] = std::fmax(scale[i], std::fabs(J(i, j)));
    }
  }
  bool negative = false;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(J(i, k)) * scale[pivot] > std::fabs(J(pivot, k)) * scale[i]) pivot = i;
    if (!(std::fabs(J(pivot, k)) > kMinPivot * scale[pivot])) return PoseSides::kSingular;
    if (pivot != k) {
      negative = !negative;
      std::swap(scale[k], scale[pivot]);
      for (std::size_t j = k; j < n; ++j) std::swap(J(k, j), J(pivot, j));
    }
    negative = negative != (J(k, k) < 0);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = J(i, k) / J(k, k);
      for (std::size_t j = k + 1; j < n; ++j) J(i, j) -= factor * J(k, j);
    }
  }
  return negative ? PoseSides::kNegative : PoseSides::kPositive;
}

}  // namespace pkm
