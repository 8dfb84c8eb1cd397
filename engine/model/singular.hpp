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

/// Also where an element is not finite. @param J  square
template <SmallMatrix M>
bool is_singular(const M& J) {
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

}  // namespace pkm
