// The words that kernels are written in: one formula for double and for a derivative scalar.
//
// Kernels call these unqualified, so that the overloads for the derivative scalar (dual.hpp) are found by argument
// type.
#pragma once

#include <cmath>

#include "engine/math/portable.hpp"

namespace pkm {

using portable::acos, portable::asin, portable::atan2, portable::exp, portable::log, portable::sincos, std::sqrt;

inline double value_of(double x) { return x; }

/// A scalar with derivatives: f(x) follows from f(a), f'(a) and f''(a) at its value a. Where a slope is infinite, at
/// the ends of the range of asin and acos, the derivatives are 0.
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
  const double cosine = std::sqrt((1 - x.a) * (1 + x.a)), slope = cosine > 0 ? 1 / cosine : 0;
  return x.through(portable::asin(x.a), slope, x.a * slope * slope * slope);
}
template <Derivative S>
S acos(const S& x) {
  const double sine = std::sqrt((1 - x.a) * (1 + x.a)), slope = sine > 0 ? -1 / sine : 0;
  return x.through(portable::acos(x.a), slope, x.a * slope * slope * slope);
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

/// x if the condition holds, else y; both exist.
template <class S>
[[gnu::always_inline]] inline S select(bool condition, const S& x, const S& y) {
  return condition ? x : y;
}

/// The smaller and the larger of two numbers, chosen by value.
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

template <class S>
S magnitude(const S& x) {
  return value_of(x) < 0 ? S(-x) : x;
}

/// An angle [rad] less whole turns, in (-pi, pi].
template <class S>
S wrapped(const S& angle) {
  const double turns = std::ceil(value_of(angle) / (2 * kPi) - 0.5);
  return turns == 0 ? angle : S(angle - turns * (2 * kPi));
}

/// sqrt(x) where x > 0, else 0 with derivative 0 (the end of a range, where the true slope is infinite).
template <class S>
S root_or_zero(const S& x) {
  return value_of(x) > 0 ? sqrt(x) : S(0.0);
}

}  // namespace pkm
