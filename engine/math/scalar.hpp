// The words that kernels are written in: one formula for double and for a derivative scalar.
//
// Kernels call these unqualified. A derivative scalar supplies its own overloads in its namespace (found by argument
// type) for sqrt, and here for the rest through `chain`: value and derivative of a function of one number.
#pragma once

#include <cmath>
#include <type_traits>

#include "engine/math/portable.hpp"

namespace pkm {

using std::sqrt;

inline double value_of(double x) { return x; }

/// A derivative scalar: anything with a value `.a` and a derivative vector `.v` (as ceres::Jet has).
template <class S>
concept DerivativeScalar = requires(S s) {
  { s.a } -> std::convertible_to<double>;
  s.v;
};

template <DerivativeScalar S>
double value_of(const S& x) {
  return x.a;
}

/// f(x) given f and f' at x's value.
template <DerivativeScalar S>
S chain(const S& x, double f, double slope) {
  S result = x;
  result.a = f;
  result.v *= slope;
  return result;
}

template <class S>
struct SinCosOf {
  S sin, cos;
};

inline SinCosOf<double> sincos(double x) {
  const auto [s, c] = portable::sincos(x);
  return {s, c};
}
template <DerivativeScalar S>
SinCosOf<S> sincos(const S& x) {
  const auto [s, c] = portable::sincos(x.a);
  return {chain(x, s, c), chain(x, c, -s)};
}

inline double atan2(double y, double x) { return portable::atan2(y, x); }
template <DerivativeScalar S>
S atan2(const S& y, const S& x) {
  const double norm = x.a * x.a + y.a * y.a;
  S result = y;
  result.a = portable::atan2(y.a, x.a);
  result.v = (y.v * x.a - x.v * y.a) / norm;
  return result;
}

inline double asin(double x) { return portable::asin(x); }
template <DerivativeScalar S>
S asin(const S& x) {
  return chain(x, portable::asin(x.a), 1.0 / std::sqrt((1.0 - x.a) * (1.0 + x.a)));
}

inline double acos(double x) { return portable::acos(x); }
template <DerivativeScalar S>
S acos(const S& x) {
  return chain(x, portable::acos(x.a), -1.0 / std::sqrt((1.0 - x.a) * (1.0 + x.a)));
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

/// sqrt(x) where x > 0, else 0 with derivative 0 (the end of a range, where the true slope is infinite).
template <class S>
S root_or_zero(const S& x) {
  return value_of(x) > 0 ? sqrt(x) : S(0.0);
}

}  // namespace pkm
