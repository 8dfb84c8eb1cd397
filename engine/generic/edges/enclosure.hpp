// First-order Taylor models with a bound on the second derivative: enclosures of a function and of its derivative over
// an interval [m - h, m + h].
//
//   f(m + x) is within B x^2 / 2 of f(m) + f'(m) x, and f'(m + x) within B |x| of f'(m), where B >= |f''| on the
//   interval
//
// Compared with interval arithmetic, enclosures converge quadratically in h, and a product takes a few operations
// without branches. With h = 0 a Taylor model is a value with its derivative. Operations are not rounded outwards;
// callers allow for rounding errors.
//
// Reference: Makino, Berz, "Taylor models and other validated functional inclusion methods", Int. J. Pure Appl. Math. 4
// (2003), 379.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/portable.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm::generic::edges {

using Vector3 = Vector<double, 3>;
inline double norm(const Vector3& v) { return std::sqrt(dot(v, v)); }
/// Largest magnitude of a component.
inline double largest(const Vector3& v) { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

struct Enclosure {
  double value = 0, slope = 0;  ///< value and first derivative of the function at the middle of the interval
  double bend = 0;              ///< upper bound of the magnitude of the function's second derivative in the interval
  double h = 0;                 ///< half the width of the interval; 0 at a single point, and for constants

  Enclosure() = default;
  Enclosure(double number) : value(number) {}  // not explicit: formulas mix enclosures with constants
  Enclosure(double f, double f1, double bound, double half) : value(f), slope(f1), bend(bound), h(half) {}
  static Enclosure variable(double middle, double half) { return {middle, 1, 0, half}; }

  /// Upper bound, in the interval, of the difference between the function and its value at the middle.
  double reach() const { return (std::fabs(slope) + 0.5 * bend * h) * h; }
  double max_magnitude() const { return std::fabs(value) + reach(); }
  double max_slope() const { return std::fabs(slope) + bend * h; }
  /// true: the function is strictly monotone in the interval, proved up to rounding errors
  bool is_monotone() const { return std::fabs(slope) > bend * h; }

  friend Enclosure operator-(const Enclosure& x) { return {-x.value, -x.slope, x.bend, x.h}; }
  friend Enclosure operator+(const Enclosure& x, const Enclosure& y) {
    return {x.value + y.value, x.slope + y.slope, x.bend + y.bend, std::max(x.h, y.h)};
  }
  friend Enclosure operator-(const Enclosure& x, const Enclosure& y) { return x + -y; }
  friend Enclosure operator*(const Enclosure& x, const Enclosure& y) {
    return {x.value * y.value, x.slope * y.value + x.value * y.slope,
            x.bend * y.max_magnitude() + 2 * x.max_slope() * y.max_slope() + x.max_magnitude() * y.bend,
            std::max(x.h, y.h)};
  }
  friend Enclosure operator+(const Enclosure& x, double y) { return {x.value + y, x.slope, x.bend, x.h}; }
  friend Enclosure operator-(const Enclosure& x, double y) { return {x.value - y, x.slope, x.bend, x.h}; }
  friend Enclosure operator*(const Enclosure& x, double y) {
    return {x.value * y, x.slope * y, x.bend * std::fabs(y), x.h};
  }
  Enclosure& operator+=(const Enclosure& y) { return *this = *this + y; }

  /// The composition f(x) of a function f and this enclosure x.
  /// @param f, f1           value and derivative of f at the value of x at the middle
  /// @param max_f1, max_f2  bounds of |f'| and |f''| on the range of x
  Enclosure through(double f, double f1, double max_f1, double max_f2) const {
    return {f, f1 * slope, max_f2 * max_slope() * max_slope() + max_f1 * bend, h};
  }
};

inline Enclosure square(const Enclosure& x) {
  return {x.value * x.value, 2 * x.value * x.slope, 2 * (x.max_slope() * x.max_slope() + x.max_magnitude() * x.bend),
          x.h};
}
/// Bound of the second derivative, too large to decide anything, for a function that may be undefined in the interval.
inline constexpr double kUnbounded = 1e60;

inline Enclosure inverse(const Enclosure& x) {
  const double low = std::fabs(x.value) - x.reach();
  if (!(low > 0)) return {x.value != 0 ? 1 / x.value : 0, 0, kUnbounded, x.h};
  const double f = 1 / x.value, bound = 1 / (low * low);
  return x.through(f, -f * f, bound, 2 * bound / low);
}
inline Enclosure sqrt(const Enclosure& x) {
  const double low = x.value - x.reach(), root = std::sqrt(std::max(x.value, 0.0));
  if (!(low > 0)) return {root, 0, kUnbounded, x.h};
  const double bound = 0.5 / std::sqrt(low);
  return x.through(root, 0.5 / root, bound, 0.5 * bound / low);
}
struct SineCosine {
  Enclosure sine, cosine;
};
inline SineCosine sine_cosine(const Enclosure& x) {
  const auto [s, c] = portable::sincos(x.value);
  const double reach = std::min(x.reach(), 2.0);
  const double max_sine = std::min(1.0, std::fabs(s) + reach), max_cosine = std::min(1.0, std::fabs(c) + reach);
  return {x.through(s, c, max_cosine, max_sine), x.through(c, -s, max_sine, max_cosine)};
}
/// Enclosure of sin(x) / x. @param of_x  the result of sine_cosine(x)
inline Enclosure sinc(const Enclosure& x, const SineCosine& of_x) {
  const double t = x.value, t2 = t * t, s = of_x.sine.value, c = of_x.cosine.value;
  const bool is_small = std::fabs(t) < 0.3;  // for smaller |t| the series is accurate to 1e-16
  const double f = is_small ? 1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110)))) : s / t;
  const double f1 = is_small ? -t / 3 * (1 - t2 / 10 * (1 - t2 / 28 * (1 - t2 / 54 * (1 - t2 / 88)))) : (c - f) / t;
  return x.through(f, f1, 0.5, 1.0 / 3);
}

using Enclosure3 = Vector<Enclosure, 3>;
/// The sum of p[i] v[i], with the operations of the template dot() but for the widths, which are equal.
inline Enclosure dot(const Enclosure3& p, const Vector3& v) {
  return {p[0].value * v[0] + p[1].value * v[1] + p[2].value * v[2],
          p[0].slope * v[0] + p[1].slope * v[1] + p[2].slope * v[2],
          p[0].bend * std::fabs(v[0]) + p[1].bend * std::fabs(v[1]) + p[2].bend * std::fabs(v[2]),
          std::max({p[0].h, p[1].h, p[2].h})};
}
inline Vector3 values(const Enclosure3& p) { return {{p[0].value, p[1].value, p[2].value}}; }
inline Vector3 slopes(const Enclosure3& p) { return {{p[0].slope, p[1].slope, p[2].slope}}; }

}  // namespace pkm::generic::edges
