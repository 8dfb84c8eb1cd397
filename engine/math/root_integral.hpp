// The integral of the root of a quadratic, over a range on which the quadratic is not negative: circles, ellipses and
// hyperbolas seen as y(x) alike.
//
// With the roots r and r' at both ends, h the length of the range and q_2 the coefficient of x^2,
//
//   s = r + r',  d = r' - r,  y = q_2 h^2 / s^2:     integral = h/(4 s) (s^2 (2 - y U(y)) + d^2 U(y))
//
//   U(y) = (1 - (1 - y) T(y)) / y = 2 sum of y^k / ((2k + 1)(2k + 3)),   T(y) = artanh(sqrt y) / sqrt y, or the same
//   with arctan and -y where y < 0
//
// T h 2/s is the integral of 1/root. The usual formulas in q_1, q_2 and arc functions are this one, but lose all digits
// where q_2 or h is small.
#pragma once

#include "engine/math/scalar.hpp"

namespace pkm {

/// U(y) above, for y < 1.
template <class S>
S root_integral_series(const S& y) {
  if (std::fabs(value_of(y)) <= 1.0 / 16) {  // 12 terms: the rest is below 2^-53
    S sum(0.0);
    for (int k = 11; k >= 0; --k) sum = sum * y + 2.0 / ((2 * k + 1) * (2 * k + 3));
    return sum;
  }
  const bool hyperbola = value_of(y) > 0;
  const S root = sqrt(S(hyperbola ? y : -y));
  const S T = (hyperbola ? S(log(S((1.0 + root) / (1.0 - root))) * 0.5) : atan2(root, S(1.0))) / root;
  return (1.0 - (1.0 - y) * T) / y;
}

/// Integral of sqrt(q_0 + q_1 x + q_2 x^2) over a range.
/// @param length           of the range
/// @param at_from, at_to   the root at its ends
/// @param curvature        q_2
template <class S>
S root_integral(const S& length, const S& at_from, const S& at_to, const S& curvature) {
  const S sum = at_from + at_to, difference = at_to - at_from;
  if (!(value_of(sum) > 0)) return S(0.0);  // a range without length
  const S square = sum * sum, y = curvature * length * length / square, U = root_integral_series(y);
  return length * 0.25 / sum * (square * (2.0 - y * U) + difference * difference * U);
}

}  // namespace pkm
