// Test whether a Jacobian is singular to working precision: the only criterion used before dividing by a Jacobian.
//
// rcond(J) = 1 / (|J| |J^-1|), where |.| is the maximum absolute row sum, is the relative distance of J to the nearest
// singular matrix. The elements of J have relative errors of about 1e-16, so J is reliably regular only if rcond is
// much larger. At rcond = kSingularRcond, a result of dividing by J has at most four correct digits.
//
// J is used in m and rad, without scaling. Normalising its rows or columns would hide a column that consists of
// rounding errors only (1e-17, a rotation that no drive resists). Scaling with a characteristic length L of the
// mechanism would change rcond at most by the factor L or 1/L (in m); for mechanisms between 1 mm and 1 km, regular
// poses stay nine orders of magnitude away from the threshold.
//
// Reference: Higham, "Accuracy and Stability of Numerical Algorithms", 2nd ed., theorem 6.5 (distance to
// singularity).
#pragma once

#include "engine/math/small_matrix.hpp"

namespace pkm {

inline constexpr double kSingularRcond = 1e-12;  ///< a matrix with a smaller rcond counts as singular

/// Cheap sufficient test for rcond(J) > 10 kSingularRcond, from the LU factor U. With x = max 1 / |u_kk| and
/// r = max |u_kj| / |u_kk|, no element of U^-1 exceeds x (1 + r)^(n - 1), and no element of L^-1 exceeds 2^(n - 1),
/// because partial pivoting limits the elements of L to 1. Sums replace the maxima, because they propagate NaN.
/// @param u  J or its transpose after eliminate(): its upper triangle is U
template <SmallMatrix M>
bool is_clearly_regular(const M& J, const M& u) {
  const std::size_t n = J.rows();
  double all = 0, beside = 0, inverse = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) all += std::fabs(value_of(J(i, j)));
    for (std::size_t j = i + 1; j < n; ++j) beside += std::fabs(value_of(u(i, j)));
    inverse += 1 / std::fabs(value_of(u(i, i)));
  }
  double bound = static_cast<double>(n * n) * all * inverse;
  for (std::size_t k = 1; k < n; ++k) bound *= 2 * (1 + beside * inverse);
  return bound <= 0.1 / kSingularRcond;
}

/// True if rcond(J) < kSingularRcond, or if an element is not finite.
/// @param J           square
/// @param eliminated  J or its transpose after eliminate()
template <SmallMatrix M>
bool is_singular(const M& J, const M& eliminated) {
  if (is_clearly_regular(J, eliminated)) return false;
  const std::size_t n = J.rows();
  using Plain = MatrixOf<double, M::kRows, M::kColumns, M::kFixed>;
  auto values = Plain::zero(n, n);
  for (std::size_t k = 0; k < J.size(); ++k) values[k] = value_of(J[k]);
  const auto norm = [n](const Plain& m) {
    double max = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += std::fabs(m(i, j));
      if (!(sum <= max)) max = sum;  // also true if the sum is NaN, so that the maximum becomes NaN
    }
    return max;
  };
  return !(norm(values) * norm(solve(values, Plain::identity(n))) <= 1 / kSingularRcond);
}

/// True if rcond(J) < kSingularRcond, or if an element of J is not finite. Factorises J itself.
template <SmallMatrix M>
bool is_singular(const M& J) {
  M u = J;
  eliminate(u);
  return is_singular(J, u);
}

/// The upper triangular factor R of J = Q R, by modified Gram-Schmidt; R has the singular values of J. NaN if a column
/// is exactly linearly dependent on those before it.
/// @param J  with at least as many rows as columns
inline AxisMatrix<double> qr_factor(AxisMatrix<double> J) {
  auto R = AxisMatrix<double>::zero(J.cols(), J.cols());
  for (std::size_t k = 0; k < J.cols(); ++k) {
    double square = 0;
    for (std::size_t i = 0; i < J.rows(); ++i) square += J(i, k) * J(i, k);
    R(k, k) = std::sqrt(square);
    for (std::size_t j = k + 1; j < J.cols(); ++j) {
      for (std::size_t i = 0; i < J.rows(); ++i) R(k, j) += J(i, k) / R(k, k) * J(i, j);
      for (std::size_t i = 0; i < J.rows(); ++i) J(i, j) -= J(i, k) / R(k, k) * R(k, j);
    }
  }
  return R;
}

/// Singularity criterion of a redundantly actuated mechanism: true if the rank of J is less than its number of columns.
/// The platform can then move while all joints are locked. @param J  joints x coordinates
inline bool is_rank_deficient(const AxisMatrix<double>& J) {
  if (J.rows() < J.cols()) return true;
  return is_singular(J.rows() == J.cols() ? J : qr_factor(J));
}

}  // namespace pkm
