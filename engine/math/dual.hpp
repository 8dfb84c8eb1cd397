// Dual numbers: forward-mode automatic differentiation with respect to N variables.
//
// A dual number (a, v) is a value a with its gradient v with respect to the variables p. Every operation applies the
// chain rule:
//
//   (a, v) + (b, w) = (a + b, v + w)            (a, v) (b, w) = (a b, a w + b v)
//   (a, v) / (b, w) = (a/b, (v - (a/b) w)/b)    sqrt(a, v)    = (sqrt a, v / (2 sqrt a))
//
// Therefore a formula that is a template over the scalar type gives derivatives exact to rounding. Values are computed
// by the same operations in the same order as with double, and are bit-identical. At -1 and 1, where the derivatives of
// asin and acos are infinite, they are set to 0, like those of sqrt_or_zero at 0: no usable derivative exists there,
// and 0 preserves the derivatives of the other terms of a sum.
//
// Why not ceres::Jet or Eigen's AutoDiffScalar: they use the functions of libm (see portable.hpp), and their division
// rounds differently from that of double. Workspace analysis by columns with 4 variables takes 2.4 times as long as
// without derivatives (benchmark column_gradient/without_limits).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/math/scalar.hpp"

namespace pkm {

/// Vector of N numbers with component-wise addition and scaling, two numbers at a time: GCC 12 vectorises scalar loops
/// only in part, and their operands then go by way of the stack.
template <int N>
struct alignas(16) Components {
  typedef double Pair __attribute__((vector_size(16)));

  double d[N + N % 2] = {};  // if N is odd, the last number is unused

  [[gnu::always_inline]] double operator[](int i) const { return d[i]; }
  [[gnu::always_inline]] double& operator[](int i) { return d[i]; }
  [[gnu::always_inline]] Pair pair(int i) const {
    Pair both;
    std::memcpy(&both, d + i, sizeof both);
    return both;
  }
  [[gnu::always_inline]] void set_pair(int i, const Pair& both) { std::memcpy(d + i, &both, sizeof both); }

  [[gnu::always_inline]] friend Components operator+(const Components& x, const Components& y) {
    Components r;
#pragma GCC unroll 8
    for (int i = 0; i < N; i += 2) r.set_pair(i, x.pair(i) + y.pair(i));
    return r;
  }
  [[gnu::always_inline]] friend Components operator-(const Components& x, const Components& y) {
    Components r;
#pragma GCC unroll 8
    for (int i = 0; i < N; i += 2) r.set_pair(i, x.pair(i) - y.pair(i));
    return r;
  }
  [[gnu::always_inline]] friend Components operator*(const Components& x, double factor) {
    Components r;
#pragma GCC unroll 8
    for (int i = 0; i < N; i += 2) r.set_pair(i, x.pair(i) * factor);
    return r;
  }
};

/// A dual number with N derivatives.
template <int N>
struct Dual {
  static constexpr int kDerivatives = N;

  double a = 0;     ///< value
  Components<N> v;  ///< gradient: the N partial derivatives

  [[gnu::always_inline]] Dual() {}
  /// This constructor is not explicit, because formulas combine constants and dual numbers.
  [[gnu::always_inline]] Dual(double value) : a(value) {}
  [[gnu::always_inline]] Dual(double value, const Components<N>& derivatives) : a(value), v(derivatives) {}
  /// The independent variable number `index` with the given value: its gradient is the unit vector number `index`.
  static Dual variable(double value, int index) {
    Dual x(value);
    x.v[index] = 1;
    return x;
  }

  /// Chain rule: f(x), given the value f and the first derivative f1 of the function at the value of x.
  [[gnu::always_inline]] Dual through(double f, double f1, double) const { return {f, v * f1}; }

  [[gnu::always_inline]] Dual& operator+=(const Dual& y) { return *this = *this + y; }
  [[gnu::always_inline]] Dual& operator-=(const Dual& y) { return *this = *this - y; }
  [[gnu::always_inline]] Dual& operator*=(const Dual& y) { return *this = *this * y; }
  [[gnu::always_inline]] Dual& operator/=(const Dual& y) { return *this = *this / y; }

  [[gnu::always_inline]] friend Dual operator-(const Dual& x) { return {-x.a, x.v * -1.0}; }
  [[gnu::always_inline]] friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, const Dual& y) {
    return {x.a * y.a, y.v * x.a + x.v * y.a};
  }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, const Dual& y) {
    const double quotient = x.a / y.a, inverse = 1 / y.a;
    return {quotient, (x.v - y.v * quotient) * inverse};
  }
  // Operations with a constant, which has no derivatives.
  [[gnu::always_inline]] friend Dual operator+(const Dual& x, double y) { return {x.a + y, x.v}; }
  [[gnu::always_inline]] friend Dual operator+(double x, const Dual& y) { return {x + y.a, y.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, double y) { return {x.a - y, x.v}; }
  [[gnu::always_inline]] friend Dual operator-(double x, const Dual& y) { return {x - y.a, y.v * -1.0}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, double y) { return {x.a * y, x.v * y}; }
  [[gnu::always_inline]] friend Dual operator*(double x, const Dual& y) { return {x * y.a, y.v * x}; }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, double y) { return {x.a / y, x.v * (1 / y)}; }
  [[gnu::always_inline]] friend Dual operator/(double x, const Dual& y) {
    const double quotient = x / y.a;
    return {quotient, y.v * (-quotient / y.a)};
  }
};

template <int N>
Dual<N> atan2(const Dual<N>& y, const Dual<N>& x) {
  const double norm = x.a * x.a + y.a * y.a;
  return {portable::atan2(y.a, x.a), (y.v * x.a - x.v * y.a) * (1 / norm)};
}

/// Derivatives with respect to four variables; for more variables, a computation is repeated in blocks of four.
using Dual4 = Dual<4>;

}  // namespace pkm
