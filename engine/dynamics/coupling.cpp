#include "engine/dynamics/coupling.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace pkm {
namespace {

/// Implementation of extreme_eigenvectors() for matrices of one size.
/// @tparam N  number of rows, or Eigen::Dynamic
template <int N>
std::optional<ExtremeEigenvectors> extreme(std::span<const double> elements, int n) {
  constexpr int kMax = N == Eigen::Dynamic ? static_cast<int>(ExtremeEigenvectors::kMax) : N;
  using Values = Eigen::Matrix<double, N, N, 0, kMax, kMax>;
  const Values values = Eigen::Map<const Eigen::Matrix<double, N, N, Eigen::RowMajor>>(elements.data(), n, n);
  if (!values.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Values> eigen(values);
  ExtremeEigenvectors vectors;
  std::copy_n(eigen.eigenvectors().col(0).data(), n, vectors.smallest.begin());
  std::copy_n(eigen.eigenvectors().col(n - 1).data(), n, vectors.largest.begin());
  return vectors;
}

}  // namespace

std::optional<ExtremeEigenvectors> extreme_eigenvectors(std::span<const double> elements, std::size_t n) {
  return n == 4 ? extreme<4>(elements, 4) : extreme<Eigen::Dynamic>(elements, static_cast<int>(n));
}

}  // namespace pkm
