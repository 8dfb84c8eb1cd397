// Second-order forward-mode automatic differentiation with respect to one variable (time): a value with its first and
// second derivative.
//
//   (x y)' = x' y + x y'          (x y)'' = x'' y + 2 x' y' + x y''
//   f(x)'  = f'(x) x'             f(x)''  = f''(x) x'^2 + f'(x) x''
//
// A formula of time evaluated with this type gives position, velocity and acceleration at once, exact to rounding
// errors. Values are bit-identical to those of the same formula with double.
#pragma once

#include "engine/math/scalar.hpp"

namespace pkm {

/// Value and the first two derivatives with respect to time.
struct Taylor {
  double a = 0;   ///< value of the function
  double d = 0;   ///< first derivative
  double dd = 0;  ///< second derivative

  Taylor() = default;
  Taylor(double value) : a(value) {}  // not explicit, because formulas combine constants and Taylor numbers
  Taylor(double value, double first, double second) : a(value), d(first), dd(second) {}
  /// The time itself, as the independent variable, with the given value: its derivatives are 1 and 0.
  static Taylor variable(double value) { return {value, 1, 0}; }

  friend Taylor operator-(const Taylor& x) { return {-x.a, -x.d, -x.dd}; }
  friend Taylor operator+(const Taylor& x, const Taylor& y) { return {x.a + y.a, x.d + y.d, x.dd + y.dd}; }
  friend Taylor operator-(const Taylor& x, const Taylor& y) { return {x.a - y.a, x.d - y.d, x.dd - y.dd}; }
  friend Taylor operator*(const Taylor& x, const Taylor& y) {
    return {x.a * y.a, x.d * y.a + x.a * y.d, x.dd * y.a + 2 * x.d * y.d + x.a * y.dd};
  }
  friend Taylor operator/(const Taylor& x, const Taylor& y) {  // derivatives of the quotient q from those of x = q y
    const double q = x.a / y.a, dq = (x.d - q * y.d) / y.a;
    return {q, dq, (x.dd - 2 * dq * y.d - q * y.dd) / y.a};
  }
  Taylor& operator+=(const Taylor& y) { return *this = *this + y; }

  /// Chain rule: f(x), given the value f and the derivatives f1, f2 of the function at the value of x.
  Taylor through(double f, double f1, double f2) const { return {f, f1 * d, f2 * d * d + f1 * dd}; }
};

inline Taylor atan2(const Taylor& y, const Taylor& x) {
  const double n = x.a * x.a + y.a * y.a, dn = 2 * (x.a * x.d + y.a * y.d);
  const double rate = (x.a * y.d - y.a * x.d) / n;
  return {portable::atan2(y.a, x.a), rate, (x.a * y.dd - y.a * x.dd - rate * dn) / n};
}

}  // namespace pkm
