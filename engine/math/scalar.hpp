// Elementary functions for templates over the scalar type: double, or a type with derivatives (dual.hpp, taylor.hpp).
//
// Templates call these functions unqualified, so that the overload for the scalar type is selected by its argument.
#pragma once

#include <cmath>

#include "engine/math/portable.hpp"

namespace pkm {

using portable::acos, portable::asin, portable::atan2, portable::exp, portable::log, portable::sincos, std::sqrt;

/// The value of a number without its derivatives.
inline double value_of(double x) { return x; }

/// A scalar type with derivatives, such as Dual and Taylor. x.through(f, f1, f2) applies the chain rule: it computes
/// f(x) from f(a), f'(a) and f''(a) at the value a of x. At -1 and 1, where the derivatives of asin and acos are
/// infinite, they are set to 0.
template <class S>
concept Derivative = requires(const S& x) {
  x.through(x.a, x.a, x.a);
};

template <Derivative S>
double value_of(const S& x) {
  return x.a;
}
template <Derivative S>
[[gnu::always_inline]] inline S sqrt(const S& x) {
  const double root = std::sqrt(x.a);
  return x.through(root, 0.5 / root, -0.25 / (root * x.a));
}
template <Derivative S>
SinCosOf<S> sincos(const S& x) {
  const auto [s, c] = portable::sincos(x.a);
  return {x.through(s, c, -s), x.through(c, -s, -c)};
}
template <Derivative S>
S asin(const S& x) {
  const double cosine = std::sqrt((1 - x.a) * (1 + x.a)), derivative = cosine > 0 ? 1 / cosine : 0;
  return x.through(portable::asin(x.a), derivative, x.a * derivative * derivative * derivative);
}
template <Derivative S>
S acos(const S& x) {
  const double sine = std::sqrt((1 - x.a) * (1 + x.a)), derivative = sine > 0 ? -1 / sine : 0;
  return x.through(portable::acos(x.a), derivative, x.a * derivative * derivative * derivative);
}
template <Derivative S>
S exp(const S& x) {
  const double e = portable::exp(x.a);
  return x.through(e, e, e);
}
template <Derivative S>
S log(const S& x) {
  return x.through(portable::log(x.a), 1 / x.a, -1 / (x.a * x.a));
}

/// x if the condition is true, otherwise y. Both arguments are evaluated.
template <class S>
[[gnu::always_inline]] inline S select(bool condition, const S& x, const S& y) {
  return condition ? x : y;
}

/// Minimum and maximum of two numbers by their values, with the derivatives of the chosen one.
template <class S>
S min(const S& a, const S& b) {
  return value_of(b) < value_of(a) ? b : a;
}
template <class S>
S max(const S& a, const S& b) {
  return value_of(a) < value_of(b) ? b : a;
}
template <class S>
S clamp(const S& x, const S& lower, const S& upper) {
  return min(max(x, lower), upper);
}

/// Absolute value.
template <class S>
S magnitude(const S& x) {
  return value_of(x) < 0 ? S(-x) : x;
}

/// An angle [rad], reduced modulo 2 pi to (-pi, pi].
template <class S>
S wrapped(const S& angle) {
  const double revolutions = std::ceil(value_of(angle) / (2 * kPi) - 0.5);
  return revolutions == 0 ? angle : S(angle - revolutions * (2 * kPi));
}

/// sqrt(x) for x > 0, otherwise 0 with the derivatives 0 (at x = 0 the true derivative is infinite).
template <class S>
S sqrt_or_zero(const S& x) {
  return value_of(x) > 0 ? sqrt(x) : S(0.0);
}

}  // namespace pkm
