// Singular values of small matrices and the inverse condition number made of them.
#pragma once

#include <cstddef>

#include "engine/math/scalar.hpp"

namespace pkm {

/// sigma_min / sigma_max of an N x N matrix, in [0, 1]; 0 for a singular matrix or one that is not finite.
/// One-sided Jacobi: columns are turned in pairs until they are orthogonal; their lengths are the singular values, each
/// to high relative accuracy, for double and for a derivative scalar alike.
/// @param m      columns, m[column][row]; overwritten
/// @param extra  square of one more singular value, of a block that is diagonal already; < 0: none
template <int N, class S>
S inverse_condition(S (&m)[N][N], const S& extra = S(-1.0)) {
  constexpr int kSweeps = 30;            // 4 or 5 are enough in practice
  constexpr double kOrthogonal = 1e-15;  // cosine between two columns that counts as 0
  const auto dot = [&](int i, int j) {
    S sum = m[i][0] * m[j][0];
    for (int k = 1; k < N; ++k) sum += m[i][k] * m[j][k];
    return sum;
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool turned = false;
    for (int i = 0; i < N - 1; ++i)
      for (int j = i + 1; j < N; ++j) {
        const S aa = dot(i, i), bb = dot(j, j), ab = dot(i, j);
        const double scale = value_of(aa) * value_of(bb), product = value_of(ab) * value_of(ab);
        if (!(product > kOrthogonal * kOrthogonal * scale)) continue;  // also leaves NaN alone
        turned = true;
        const S zeta = (bb - aa) / (ab * 2.0);
        const S root = sqrt(S(zeta * zeta + 1.0));
        const S t = value_of(zeta) >= 0 ? S(1.0 / (zeta + root)) : S(-1.0 / (root - zeta));
        const S c = S(1.0) / sqrt(S(t * t + 1.0)), s = c * t;
        for (int k = 0; k < N; ++k) {
          const S p = m[i][k], q = m[j][k];
          m[i][k] = c * p - s * q;
          m[j][k] = s * p + c * q;
        }
      }
    if (!turned) break;
  }
  S least = dot(0, 0), greatest = least;
  if (value_of(extra) >= 0) {
    least = min(least, extra);
    greatest = max(greatest, extra);
  }
  for (int i = 1; i < N; ++i) {
    const S length = dot(i, i);
    least = min(least, length);
    greatest = max(greatest, length);
  }
  const bool usable = value_of(least) > 0 && value_of(greatest) < 1e300;
  return usable ? S(sqrt(S(least / greatest))) : S(0.0);
}

}  // namespace pkm
