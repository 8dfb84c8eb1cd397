// Interval arithmetic with outward rounding: a formula evaluated with intervals gives an interval that is proven to
// contain all of its values for arguments in the given intervals (certified bounds).
//
// Every operation is rounded to nearest, and the bounds are then widened to the next double. The rounding mode of the
// processor is never changed: libraries that change it give wrong bounds if the compiler moves an operation across the
// change. Elementary functions are those of portable.hpp, widened by error bounds that are derived in interval.cpp.
//
// If a formula is undefined for some arguments (for example, the square root of [-1, 1]), the interval contains its
// values for the others, and its decoration is `partial`. If it is undefined for all arguments, the interval is empty.
// Infinite values count as undefined. Constants, including `pi`, mean exactly the double that represents them.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pkm {

/// Decoration of an interval (IEEE 1788-2015: dac, def, trv): the strongest property that is proven for the formula on
/// the whole box of its arguments. `continuous`: defined and continuous; `defined`: defined, possibly discontinuous;
/// `partial`: possibly undefined.
enum class Decoration : unsigned char { continuous, defined, partial };

/// A closed interval with a decoration. lower <= upper, lower < infinity and upper > -infinity; both bounds are NaN if
/// the interval is empty.
struct Interval {
  double lower = 0, upper = 0;
  Decoration decoration = Decoration::continuous;

  Interval() = default;
  /// The interval [value, value]; empty (undefined) if the value is not finite.
  Interval(double value) {  // not explicit, because formulas combine constants and intervals
    *this = std::isfinite(value) ? Interval(value, value) : empty();
  }
  Interval(double from, double to, Decoration known = Decoration::continuous)
      : lower(from), upper(to), decoration(known) {}
  static Interval empty() {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return {kNaN, kNaN, Decoration::partial};
  }
  static Interval everything(Decoration known) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {-kInfinity, kInfinity, known};
  }

  bool is_empty() const { return lower != lower; }
  /// Whether the interval is a single number.
  bool is_number() const { return lower == upper; }
  bool is_defined() const { return decoration != Decoration::partial; }
  bool is_continuous() const { return decoration == Decoration::continuous; }
  bool holds(double value) const { return lower <= value && value <= upper; }
  double width() const { return upper - lower; }
  /// A number in the interval: approximately its midpoint, or an arbitrary finite number if the interval is unbounded.
  double middle() const;

  /// True if it is certified that the formula is defined and >= 0 for all arguments.
  bool is_certified_satisfied() const { return lower >= 0 && is_defined(); }
  /// True if it is certified that the formula is negative or undefined for all arguments.
  bool is_certified_violated() const { return !(upper >= 0); }
};

/// The next double towards +infinity or -infinity (IEEE 754 nextUp, nextDown). An infinity of the opposite sign, which
/// is the result of an overflow, becomes the finite double next to it.
inline double next_up(double x) {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (!(std::fabs(x) <= kMax)) return x < 0 ? -kMax : x;
  const auto bits = std::bit_cast<std::int64_t>(x + 0.0);  // -0 becomes 0
  return std::bit_cast<double>(bits + ((bits >> 63) | 1));
}
inline double next_down(double x) { return -next_up(-x); }

/// The weaker of two decorations: that of an operation whose operands have these.
inline Decoration weaker(Decoration a, Decoration b) { return a < b ? b : a; }
inline Decoration weaker(const Interval& x, const Interval& y) { return weaker(x.decoration, y.decoration); }

namespace rounding {
// Lower (_down) and upper (_up) bounds of a sum, product and quotient of two numbers. Exact cases are not widened: a
// sum that rounds to 0 is 0, and so are a product with the factor 0 and a quotient with the numerator 0.

/// up_from() returns the next double towards +infinity, down_from() the next one towards -infinity; the argument must
/// not be 0.
inline double up_from(double x) {
  if (!(std::fabs(x) <= std::numeric_limits<double>::max())) [[unlikely]]
    return next_up(x);
  const auto bits = std::bit_cast<std::int64_t>(x);
  return std::bit_cast<double>(bits + ((bits >> 63) | 1));
}
inline double down_from(double x) {
  if (!(std::fabs(x) <= std::numeric_limits<double>::max())) [[unlikely]]
    return next_down(x);
  const auto bits = std::bit_cast<std::int64_t>(x);
  return std::bit_cast<double>(bits - ((bits >> 63) | 1));
}
inline bool is_zero_or_nan(double x) { return x == 0 || x != x; }
inline double sum_down(double a, double b) { return a + b == 0 ? 0 : down_from(a + b); }
inline double sum_up(double a, double b) { return a + b == 0 ? 0 : up_from(a + b); }
inline double product_down(double a, double b) {
  const double product = a * b;
  if (is_zero_or_nan(product)) [[unlikely]]
    return a == 0 || b == 0 ? 0 : next_down(product);
  return down_from(product);
}
inline double product_up(double a, double b) {
  const double product = a * b;
  if (is_zero_or_nan(product)) [[unlikely]]
    return a == 0 || b == 0 ? 0 : next_up(product);
  return up_from(product);
}
inline double quotient_down(double a, double b) { return a == 0 ? 0 : next_down(a / b); }
inline double quotient_up(double a, double b) { return a == 0 ? 0 : next_up(a / b); }
}  // namespace rounding

inline Interval operator-(const Interval& x) { return {-x.upper, -x.lower, x.decoration}; }
inline Interval operator+(const Interval& x, const Interval& y) {
  return {rounding::sum_down(x.lower, y.lower), rounding::sum_up(x.upper, y.upper), weaker(x, y)};
}
inline Interval operator-(const Interval& x, const Interval& y) {
  return {rounding::sum_down(x.lower, -y.upper), rounding::sum_up(x.upper, -y.lower), weaker(x, y)};
}
inline Interval operator*(const Interval& x, const Interval& y) {
  using namespace rounding;
  const Decoration decoration = weaker(x, y);
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  if (x.lower >= 0) {
    if (y.lower >= 0) return {product_down(x.lower, y.lower), product_up(x.upper, y.upper), decoration};
    if (y.upper <= 0) return {product_down(x.upper, y.lower), product_up(x.lower, y.upper), decoration};
    return {product_down(x.upper, y.lower), product_up(x.upper, y.upper), decoration};
  }
  if (x.upper <= 0) {
    if (y.lower >= 0) return {product_down(x.lower, y.upper), product_up(x.upper, y.lower), decoration};
    if (y.upper <= 0) return {product_down(x.upper, y.upper), product_up(x.lower, y.lower), decoration};
    return {product_down(x.lower, y.upper), product_up(x.lower, y.lower), decoration};
  }
  if (y.lower >= 0) return {product_down(x.lower, y.upper), product_up(x.upper, y.upper), decoration};
  if (y.upper <= 0) return {product_down(x.upper, y.lower), product_up(x.lower, y.lower), decoration};
  return {std::min(product_down(x.lower, y.upper), product_down(x.upper, y.lower)),
          std::max(product_up(x.lower, y.lower), product_up(x.upper, y.upper)), decoration};
}
Interval operator/(const Interval& x, const Interval& y);
inline Interval& operator+=(Interval& x, const Interval& y) { return x = x + y; }

/// The square of x, tighter than x * x, in which the two factors vary independently.
inline Interval square(const Interval& x) {
  using namespace rounding;
  const double low = std::fabs(x.lower), high = std::fabs(x.upper);
  if (x.lower <= 0 && x.upper >= 0) return {0, std::max(product_up(low, low), product_up(high, high)), x.decoration};
  const double near = x.upper < 0 ? high : low, far = x.upper < 0 ? low : high;
  return {product_down(near, near), product_up(far, far), x.decoration};
}
inline Interval sqrt(const Interval& x) {
  if (x.is_certified_violated()) return Interval::empty();
  const double low = x.lower > 0 ? next_down(std::sqrt(x.lower)) : 0;
  const double high = x.upper > 0 ? next_up(std::sqrt(x.upper)) : 0;
  return {low, high, x.lower < 0 ? Decoration::partial : x.decoration};
}
Interval magnitude(const Interval& x);
/// The sign function, with the values -1, 0 and 1.
Interval sign(const Interval& x);
/// Minimum and maximum of two arguments.
Interval min(const Interval& x, const Interval& y);
Interval max(const Interval& x, const Interval& y);

Interval sin(const Interval& x);
Interval cos(const Interval& x);
Interval tan(const Interval& x);
Interval asin(const Interval& x);
Interval acos(const Interval& x);
Interval atan(const Interval& x);
Interval atan2(const Interval& y, const Interval& x);
Interval exp(const Interval& x);
Interval log(const Interval& x);
Interval log10(const Interval& x);
Interval sinh(const Interval& x);
Interval cosh(const Interval& x);
Interval tanh(const Interval& x);
Interval pow(const Interval& x, const Interval& y);
/// An angle [rad], reduced modulo 2 pi to (-pi, pi].
Interval wrapped(const Interval& angle);

// Logical functions: [1, 1] if true for all arguments, [0, 0] if false for all, otherwise [0, 1].

/// Comparisons of intervals: x < y, x <= y, x == y, and x != 0.
Interval less(const Interval& x, const Interval& y);
Interval less_or_equal(const Interval& x, const Interval& y);
Interval equal(const Interval& x, const Interval& y);
Interval truth(const Interval& x);
/// x if the condition does not contain 0, y if it is 0; otherwise the hull of both.
Interval choose(const Interval& condition, const Interval& x, const Interval& y);

/// Intersection of two enclosures of the same quantity; the stronger decoration holds.
inline Interval intersection(const Interval& x, const Interval& y) {
  const double lower = std::max(x.lower, y.lower), upper = std::min(x.upper, y.upper);
  return lower <= upper ? Interval(lower, upper, std::min(x.decoration, y.decoration)) : Interval::empty();
}
/// The smallest interval that contains two intervals. Combined with an empty interval, the result is `partial`.
Interval hull(const Interval& x, const Interval& y);

}  // namespace pkm
