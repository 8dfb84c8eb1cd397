// Where a Jacobian is singular to working precision: the one criterion for everything that divides by it.
//
// rcond(J) = 1 / (|J| |J^-1|), with the greatest sum of a row as |.|, is the relative distance to the nearest singular
// matrix. Elements of J carry relative errors of some 1e-16, so that J is regular for sure only where rcond exceeds
// these by far; at kSingular, what is divided by J is known to four digits at most.
//
// J is taken in m and rad as it is. Rows or columns scaled to one length would hide a column that is rounding alone
// (a rotation that no drive feels: 1e-17). A length of the mechanism as scale would change rcond by at most that
// length or its inverse: of mechanisms between 1 mm and 1 km, regular poses stay nine digits away.
#pragma once

#include "engine/math/small_matrix.hpp"

namespace pkm {

inline constexpr double kSingular = 1e-12;

/// Enough for rcond(J) to exceed 10 kSingular, from what eliminate() has left of J or of its transpose, and soon told:
/// with x = 1 / |u_kk| and r = |u_kj| / |u_kk| for the greatest of each, no element of U^-1 exceeds x (1 + r)^(n - 1),
/// and none of L^-1 exceeds 2^(n - 1), because no factor exceeds 1. Sums stand for the greatest: they keep NaN.
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
  return bound <= 0.1 / kSingular;
}

/// Also where an element is not finite. @param J  square
/// @param eliminated  what eliminate() has left of J or of its transpose
template <SmallMatrix M>
bool is_singular(const M& J, const M& eliminated) {
  if (is_clearly_regular(J, eliminated)) return false;
  const std::size_t n = J.rows();
  using Plain = MatrixOf<double, M::kRows, M::kColumns, M::kFixed>;
  auto values = Plain::zero(n, n);
  for (std::size_t k = 0; k < J.size(); ++k) values[k] = value_of(J[k]);
  const auto norm = [n](const Plain& m) {
    double most = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += std::fabs(m(i, j));
      if (!(sum <= most)) most = sum;  // keeps NaN
    }
    return most;
  };
  return !(norm(values) * norm(solve(values, Plain::identity(n))) <= 1 / kSingular);
}

/// The same without one.
template <SmallMatrix M>
bool is_singular(const M& J) {
  M u = J;
  eliminate(u);
  return is_singular(J, u);
}

/// The upper triangle R of J = Q R with orthonormal columns Q, by modified Gram-Schmidt: it has J's singular values.
/// NaN where a column depends on those before it exactly. @param J  with at least as many rows as columns
inline AxisMatrix<double> triangle_of(AxisMatrix<double> J) {
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

/// The same criterion for redundant drives: whether the rank of J is less than its number of columns, so that the
/// platform can move while all joints stand still. @param J  joints x coordinates
inline bool is_rank_deficient(const AxisMatrix<double>& J) {
  if (J.rows() < J.cols()) return true;
  return is_singular(J.rows() == J.cols() ? J : triangle_of(J));
}

}  // namespace pkm
