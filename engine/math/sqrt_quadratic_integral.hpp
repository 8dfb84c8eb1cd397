// Integral of the square root of a quadratic polynomial q(x) over an interval on which q >= 0, i.e. the area under a
// conic y = sqrt(q(x)): a circle, ellipse, parabola or hyperbola.
//
// With the values r and r' of sqrt(q) at the endpoints, the length h of the interval and the coefficient q_2 of x^2,
//
//   s = r + r',  d = r' - r,  y = q_2 h^2 / s^2:     integral = h/(4 s) (s^2 (2 - y U(y)) + d^2 U(y))
//
//   U(y) = (1 - (1 - y) T(y)) / y = 2 sum of y^k / ((2k + 1)(2k + 3)),   T(y) = artanh(sqrt y) / sqrt y, or the same
//   with arctan and -y where y < 0
//
// The integral of 1/sqrt(q) is 2 h T(y) / s. The usual closed forms in q_1, q_2 and inverse trigonometric functions are
// mathematically equivalent, but lose all digits by cancellation if q_2 or h is small.
#pragma once

#include "engine/math/scalar.hpp"

namespace pkm {

/// The function U(y) = (1 - (1 - y) T(y)) / y for y < 1, where T(y) = artanh(sqrt y) / sqrt y, or arctan(sqrt -y) /
/// sqrt -y if y < 0.
template <class S>
S root_integral_series(const S& y) {
  if (std::fabs(value_of(y)) <= 1.0 / 16) {  // 12 terms: the truncation error is below 2^-53
    S sum(0.0);
    for (int k = 11; k >= 0; --k) sum = sum * y + 2.0 / ((2 * k + 1) * (2 * k + 3));
    return sum;
  }
  const bool hyperbola = value_of(y) > 0;
  const S root = sqrt(S(hyperbola ? y : -y));
  const S T = (hyperbola ? S(log(S((1.0 + root) / (1.0 - root))) * 0.5) : atan2(root, S(1.0))) / root;
  return (1.0 - (1.0 - y) * T) / y;
}

/// Integral of sqrt(q_0 + q_1 x + q_2 x^2) over an interval.
/// @param length           length of the interval of integration
/// @param at_from, at_to   values of the square root at its endpoints
/// @param curvature        q_2, the coefficient of x^2
template <class S>
S sqrt_quadratic_integral(const S& length, const S& at_from, const S& at_to, const S& curvature) {
  const S sum = at_from + at_to, difference = at_to - at_from;
  if (!(value_of(sum) > 0)) return S(0.0);  // both endpoint values are 0: the interval has the length 0
  const S square = sum * sum, y = curvature * length * length / square, U = root_integral_series(y);
  return length * 0.25 / sum * (square * (2.0 - y * U) + difference * difference * U);
}

}  // namespace pkm
