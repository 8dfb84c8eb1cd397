// Closed intervals of real numbers that hold every value which a formula takes where its arguments take those of
// theirs: what is computed with them is certain.
//
// Every operation is rounded to nearest and then goes outward to the next number, so that the processor's rounding mode
// is never changed: libraries that change it are wrong where a compiler moves operations. Elementary functions are
// those of portable.hpp, widened by a bound of their error that interval.cpp derives.
//
// Where a formula is undefined for some arguments (the root of an interval from -1 to 1), the interval holds its values
// for the others, and says so; where it is undefined for all of them, the interval is empty. What is infinite is
// undefined. Numbers, `pi` among them, are the doubles that they are.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pkm {

/// What is known of a formula over all of its arguments; the greater, the less.
enum class Regularity : unsigned char { continuous, defined, partial };

/// lower <= upper, which are no infinities of the other side; both are NaN if it is empty.
struct Interval {
  double lower = 0, upper = 0;
  Regularity regularity = Regularity::continuous;

  Interval() = default;
  /// What is no finite number is undefined.
  Interval(double value) {  // not explicit: constants mix with intervals in formulas
    *this = std::isfinite(value) ? Interval(value, value) : empty();
  }
  Interval(double from, double to, Regularity known = Regularity::continuous)
      : lower(from), upper(to), regularity(known) {}
  static Interval empty() {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return {kNaN, kNaN, Regularity::partial};
  }
  static Interval everything(Regularity known) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {-kInfinity, kInfinity, known};
  }

  bool is_empty() const { return lower != lower; }
  bool is_number() const { return lower == upper; }
  bool is_defined() const { return regularity != Regularity::partial; }
  bool is_continuous() const { return regularity == Regularity::continuous; }
  bool holds(double value) const { return lower <= value && value <= upper; }
  double width() const { return upper - lower; }
  /// A number in it, near its middle; of what is not bounded some number.
  double middle() const;

  /// Every value of the formula is there and >= 0.
  bool surely_holds() const { return lower >= 0 && is_defined(); }
  /// Nowhere is there a value >= 0.
  bool surely_fails() const { return !(upper >= 0); }
};

/// The next number towards one of the infinities. What overflowed towards the other one comes back to a number.
inline double next_up(double x) {
  constexpr double kMost = std::numeric_limits<double>::max();
  if (!(std::fabs(x) <= kMost)) return x < 0 ? -kMost : x;
  const auto bits = std::bit_cast<std::int64_t>(x + 0.0);  // -0 becomes 0
  return std::bit_cast<double>(bits + ((bits >> 63) | 1));
}
inline double next_down(double x) { return -next_up(-x); }

inline Regularity worse(Regularity a, Regularity b) { return a < b ? b : a; }
inline Regularity worse(const Interval& x, const Interval& y) { return worse(x.regularity, y.regularity); }

namespace rounding {
// Bounds of a sum, a product and a quotient. A sum that rounds to 0 is 0; a product with the factor 0 is 0, the other
// being finite, and so is a quotient of 0.
/// next_up() and next_down() of what is not 0.
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
inline bool is_nothing(double x) { return x == 0 || x != x; }
inline double sum_down(double a, double b) { return a + b == 0 ? 0 : down_from(a + b); }
inline double sum_up(double a, double b) { return a + b == 0 ? 0 : up_from(a + b); }
inline double product_down(double a, double b) {
  const double product = a * b;
  if (is_nothing(product)) [[unlikely]]
    return a == 0 || b == 0 ? 0 : next_down(product);
  return down_from(product);
}
inline double product_up(double a, double b) {
  const double product = a * b;
  if (is_nothing(product)) [[unlikely]]
    return a == 0 || b == 0 ? 0 : next_up(product);
  return up_from(product);
}
inline double quotient_down(double a, double b) { return a == 0 ? 0 : next_down(a / b); }
inline double quotient_up(double a, double b) { return a == 0 ? 0 : next_up(a / b); }
}  // namespace rounding

inline Interval operator-(const Interval& x) { return {-x.upper, -x.lower, x.regularity}; }
inline Interval operator+(const Interval& x, const Interval& y) {
  return {rounding::sum_down(x.lower, y.lower), rounding::sum_up(x.upper, y.upper), worse(x, y)};
}
inline Interval operator-(const Interval& x, const Interval& y) {
  return {rounding::sum_down(x.lower, -y.upper), rounding::sum_up(x.upper, -y.lower), worse(x, y)};
}
inline Interval operator*(const Interval& x, const Interval& y) {
  using namespace rounding;
  const Regularity known = worse(x, y);
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  if (x.lower >= 0) {
    if (y.lower >= 0) return {product_down(x.lower, y.lower), product_up(x.upper, y.upper), known};
    if (y.upper <= 0) return {product_down(x.upper, y.lower), product_up(x.lower, y.upper), known};
    return {product_down(x.upper, y.lower), product_up(x.upper, y.upper), known};
  }
  if (x.upper <= 0) {
    if (y.lower >= 0) return {product_down(x.lower, y.upper), product_up(x.upper, y.lower), known};
    if (y.upper <= 0) return {product_down(x.upper, y.upper), product_up(x.lower, y.lower), known};
    return {product_down(x.lower, y.upper), product_up(x.lower, y.lower), known};
  }
  if (y.lower >= 0) return {product_down(x.lower, y.upper), product_up(x.upper, y.upper), known};
  if (y.upper <= 0) return {product_down(x.upper, y.lower), product_up(x.lower, y.lower), known};
  return {std::min(product_down(x.lower, y.upper), product_down(x.upper, y.lower)),
          std::max(product_up(x.lower, y.lower), product_up(x.upper, y.upper)), known};
}
Interval operator/(const Interval& x, const Interval& y);
inline Interval& operator+=(Interval& x, const Interval& y) { return x = x + y; }

/// x * x of one and the same x.
inline Interval square(const Interval& x) {
  using namespace rounding;
  const double low = std::fabs(x.lower), high = std::fabs(x.upper);
  if (x.lower <= 0 && x.upper >= 0) return {0, std::max(product_up(low, low), product_up(high, high)), x.regularity};
  const double near = x.upper < 0 ? high : low, far = x.upper < 0 ? low : high;
  return {product_down(near, near), product_up(far, far), x.regularity};
}
inline Interval sqrt(const Interval& x) {
  if (x.surely_fails()) return Interval::empty();
  const double low = x.lower > 0 ? next_down(std::sqrt(x.lower)) : 0;
  const double high = x.upper > 0 ? next_up(std::sqrt(x.upper)) : 0;
  return {low, high, x.lower < 0 ? Regularity::partial : x.regularity};
}
Interval magnitude(const Interval& x);
/// -1, 0 or 1.
Interval sign(const Interval& x);
/// The smaller and the larger of each pair.
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
/// An angle less whole turns, in (-pi, pi].
Interval wrapped(const Interval& angle);

/// 1 or 0, or what holds both: x < y, x == y, whether something is not 0.
Interval less(const Interval& x, const Interval& y);
Interval less_or_equal(const Interval& x, const Interval& y);
Interval equal(const Interval& x, const Interval& y);
Interval truth(const Interval& x);
/// x where the condition is not 0, else y.
Interval choose(const Interval& condition, const Interval& x, const Interval& y);

/// What both hold of one value that is in both.
inline Interval intersection(const Interval& x, const Interval& y) {
  const double lower = std::max(x.lower, y.lower), upper = std::min(x.upper, y.upper);
  return lower <= upper ? Interval(lower, upper, std::min(x.regularity, y.regularity)) : Interval::empty();
}
/// The least interval that holds both.
Interval hull(const Interval& x, const Interval& y);

}  // namespace pkm
