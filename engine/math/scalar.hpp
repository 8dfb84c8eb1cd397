// The words that kernels are written in: one formula for double and for a derivative scalar.
//
// Kernels call these unqualified, so that the overloads for the derivative scalar (dual.hpp) are found by argument
// type.
#pragma once

#include <cmath>

#include "engine/math/portable.hpp"

namespace pkm {

using std::sqrt;

inline double value_of(double x) { return x; }

template <class S>
struct SinCosOf {
  S sin, cos;
};

inline SinCosOf<double> sincos(double x) {
  const auto [s, c] = portable::sincos(x);
  return {s, c};
}

inline double atan2(double y, double x) { return portable::atan2(y, x); }
inline double asin(double x) { return portable::asin(x); }
inline double acos(double x) { return portable::acos(x); }
inline double exp(double x) { return portable::exp(x); }
inline double log(double x) { return portable::log(x); }

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
