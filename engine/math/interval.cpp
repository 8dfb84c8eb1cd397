#include "engine/math/interval.hpp"

#include "engine/math/portable.hpp"

// Error bounds of the elementary functions of portable.hpp, with the unit roundoff u = 2^-53. Rounding a result r to
// nearest makes an error of at most u |r|; more precisely, u/2 for |r| < 1 and u/4 for |r| < 1/2. "r rounds by e" means
// that the rounding error of r is at most e. Every bound used below is at least twice as large as the one derived here.
//
// sin, cos. The argument reduction r = x - k pi/2 uses pi/2 in three parts: two of 33 bits, and the rest. For |k| <
// 2^17 the first two products are exact, and so is the first difference (Sterbenz's lemma). The other two differences
// are below 0.79 in magnitude and round by u/2 each, and the sum of the three parts differs from pi/2 by less than
// 2^-100. Therefore the error of r is below 1.1 u; r is exact for k = 0. The series are truncated before r^17/17! <
// 0.45 u (sin) and r^18/18! (cos). sin is evaluated as r + r q S with |r q S| < 0.09, where every factor has an error
// of a few u: below 0.7 u in total, plus u/2 for the sum. Together 2.8 u. cos: the rounding error of 1 - q/2 is
// compensated; the error of q/2 < 0.31 is 0.31 u, that of the tail (below 0.02) is a few u times the tail, that of the
// sum is u/2, and the error of r enters with the factor 0.71: together 1.8 u. Bound used for both: 4 u = 2^-51. For
// k = 0, r is exact, and sin r = r (1 + e) with the relative error |e| < (0.11 * 6 + 1 + 0.45 * 0.11) u < 2 u.
//
// atan. t rounds by u/2. The tabulated tangents have an error of u/2, and t - tangent rounds by u/4. 1 + t tangent has
// a relative error of 1.5 u and the quotient rounds by u relative, with |r| < 0.132: 0.4 u. The series is truncated
// before r^23/23 < 1e-21; its tail is below 0.001. angle + (..) rounds by u/2. If the argument was inverted, pi/2 -
// (..) rounds by u/2 and u. Together 3.7 u, less than half of the bound used, 2^-50 = 8 u. For |x| < 0.13, r is exact,
// and the relative error is below 2 u.
//
// atan2. The relative error u of the quotient changes the angle by at most u/2; atan has an error of 3.7 u; pi and pi/2
// have errors of 1.2 u, and the sum, up to pi, rounds by 2 u: together 7.4 u. asin, acos: (1 - x)(1 + x) has a relative
// error of 3 u and its square root one of 2.5 u, which changes the angle by at most 1.3 u: together 8.7 u. Bound used
// for all three: 2^-48 = 32 u.
//
// exp. x - k ln2_high is exact (both terms are multiples of the last bit of x, and the difference is below 0.35), k
// ln2_low is below 2e-7, and the second difference rounds by u/4. The series is truncated before r^14/14! < 0.1 u. 1 +
// (r + r^2 s) has an error of (1 + 3 * 0.35) u, together less than 2.6 u of a value of at least 0.7, i.e. 3.7 u
// relative, plus the smallest subnormal number if the result is subnormal.
//
// log. f = m - 1 is exact. The correction of f is below 0.2 |f| with a relative error of 6 u: 1.2 u |f|. The sums round
// by u |f| each. Since |log m| > 0.83 |f|, the relative error is below 5 u for exponent 0. Otherwise |log x| > 0.34,
// the product with ln2_high is exact, the error of that with ln2_low is negligible, the terms in |f| < 0.42 have an
// error of 3.2 u |f|, and the sum rounds by u relative: below 5 u relative. Bound used for exp and log: 2^-49 = 16 u.
namespace pkm {
namespace {

using rounding::product_down, rounding::product_up, rounding::quotient_down, rounding::quotient_up, rounding::sum_down,
    rounding::sum_up;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kArcError = 0x1p-48;          // absolute error bound of asin, acos and atan2 [rad]
constexpr double kExponentialError = 0x1p-49;  // relative error bound of exp and log

// Enclosures of pi, 2 pi and pi/2: the double kPi is less than pi.
const Interval kPiInterval{kPi, next_up(kPi)}, kTwoPi{2 * kPi, next_up(2 * kPi)}, kHalfPi{kPi / 2, next_up(kPi / 2)};

/// The interval [value - error, value + error], rounded outward.
Interval around(double value, double error) { return {sum_down(value, -error), sum_up(value, error)}; }

// Enclosures of elementary functions at a single number.
Interval sine_at(double x) {
  const double s = portable::sin(x);
  return around(s, std::fabs(x) <= 0.78 ? std::fabs(s) * 0x1p-51 : 0x1p-51);
}
Interval cosine_at(double x) { return x == 0 ? Interval(1) : around(portable::cos(x), 0x1p-51); }
Interval arc_tangent_at(double x) {
  if (std::isinf(x)) return x < 0 ? -kHalfPi : kHalfPi;
  const double a = portable::atan(x);
  return around(a, std::fabs(x) <= 0.13 ? std::fabs(a) * 0x1p-51 : 0x1p-50);
}
Interval exponential_at(double x) {
  if (x == 0) return {1.0};
  if (std::isinf(x)) return x < 0 ? Interval(0) : Interval(std::numeric_limits<double>::max(), kInfinity);
  const double e = portable::exp(x);
  if (e == kInfinity) return {std::numeric_limits<double>::max() / 2, kInfinity};
  // If the result is subnormal, ldexp rounds it a second time: widen the interval by one more double on each side.
  return {std::max(0.0, next_down(product_down(e, 1 - kExponentialError))),
          next_up(product_up(e, 1 + kExponentialError))};
}
Interval logarithm_at(double x) {
  if (x == 1) return {0.0};
  if (x == 0) return {-kInfinity, -std::numeric_limits<double>::max()};
  if (std::isinf(x)) return {std::numeric_limits<double>::max() / 2, kInfinity};
  const double l = portable::log(x);
  return around(l, std::fabs(l) * kExponentialError);
}

/// Range of an increasing function from its values at the endpoints. @param at  at(number): enclosure of the value
template <class F>
Interval increasing(const F& at, const Interval& x) {
  if (x.is_empty()) return x;
  return {at(x.lower).lower, at(x.upper).upper, x.decoration};
}

/// Whether x may contain an angle 2 pi (n + offset) with an integer n.
bool may_contain_angle(const Interval& x, double offset) {
  const Interval revolutions = x / kTwoPi - Interval(offset);
  return std::ceil(revolutions.lower) <= revolutions.upper;
}

/// Range of sine or cosine, which have the value 1 at the angle 2 pi `maximum` and -1 half a period from it.
template <class F>
Interval sinusoid(const F& at, const Interval& x, double maximum) {
  if (x.is_empty()) return x;
  if (!(std::max(-x.lower, x.upper) <= 1e5)) return {-1, 1, x.decoration};
  const Interval a = at(x.lower), b = at(x.upper);
  const double lower = may_contain_angle(x, maximum + 0.5) ? -1 : std::max(-1.0, std::min(a.lower, b.lower));
  const double upper = may_contain_angle(x, maximum) ? 1 : std::min(1.0, std::max(a.upper, b.upper));
  return {lower, upper, x.decoration};
}

/// x^n for n >= 0 and x >= 0, by repeated squaring.
Interval power_of_nonnegative(Interval x, int n) {
  Interval result(1.0);
  for (; n > 0; n /= 2, x = square(x))
    if (n % 2 != 0) result = result * x;
  return result;
}
/// x^n for any integer n and any x.
Interval integer_power(const Interval& x, int n) {
  if (n < 0) return Interval(1.0) / integer_power(x, -n);
  if (n % 2 == 0 || x.lower >= 0) return power_of_nonnegative(magnitude(x), n);
  if (x.upper <= 0) return -power_of_nonnegative(-x, n);
  return {-power_of_nonnegative({0, -x.lower}, n).upper, power_of_nonnegative({0, x.upper}, n).upper, x.decoration};
}

/// The part of x in [-1, 1].
Interval in_unit_range(const Interval& x) {
  if (!(x.lower <= 1 && x.upper >= -1)) return Interval::empty();
  if (x.lower >= -1 && x.upper <= 1) return x;
  return {std::max(x.lower, -1.0), std::min(x.upper, 1.0), Decoration::partial};
}

Interval arc_at(double y, double x) { return around(portable::atan2(y, x), kArcError); }

}  // namespace

double Interval::middle() const {
  if (lower == -kInfinity) return upper == kInfinity ? 0 : std::min(-1.0, 2 * upper);
  if (upper == kInfinity) return std::max(1.0, 2 * lower);
  const double sum = lower + upper;
  return std::isinf(sum) ? lower / 2 + upper / 2 : 0.5 * sum;
}

Interval operator/(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty() || (y.lower == 0 && y.upper == 0)) return Interval::empty();
  const Decoration known = weaker(x, y);
  if (y.upper <= 0) return -x / -y;
  if (y.lower < 0) return Interval::everything(Decoration::partial);
  if (y.lower == 0) {
    if (x.lower >= 0) return {quotient_down(x.lower, y.upper), kInfinity, Decoration::partial};
    if (x.upper <= 0) return {-kInfinity, quotient_up(x.upper, y.upper), Decoration::partial};
    return Interval::everything(Decoration::partial);
  }
  return {quotient_down(x.lower, x.lower >= 0 ? y.upper : y.lower),
          quotient_up(x.upper, x.upper >= 0 ? y.lower : y.upper), known};
}

Interval hull(const Interval& x, const Interval& y) {
  if (x.is_empty()) return y.is_empty() ? y : Interval(y.lower, y.upper, Decoration::partial);
  if (y.is_empty()) return {x.lower, x.upper, Decoration::partial};
  return {std::min(x.lower, y.lower), std::max(x.upper, y.upper), weaker(x, y)};
}

Interval magnitude(const Interval& x) {
  if (x.is_empty() || x.lower >= 0) return x;
  if (x.upper <= 0) return -x;
  return {0, std::max(-x.lower, x.upper), x.decoration};
}

Interval sign(const Interval& x) {
  if (x.is_empty()) return x;
  const auto sign_of = [](double v) { return v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0; };
  const bool known = sign_of(x.lower) == sign_of(x.upper);
  return {sign_of(x.lower), sign_of(x.upper), known ? x.decoration : weaker(x.decoration, Decoration::defined)};
}

Interval min(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return {std::min(x.lower, y.lower), std::min(x.upper, y.upper), weaker(x, y)};
}
Interval max(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return {std::max(x.lower, y.lower), std::max(x.upper, y.upper), weaker(x, y)};
}

Interval sin(const Interval& x) { return sinusoid(sine_at, x, 0.25); }
Interval cos(const Interval& x) { return sinusoid(cosine_at, x, 0); }

Interval tan(const Interval& x) {
  const Interval c = cos(x);
  if (x.is_empty() || !c.holds(0))  // there is no pole in x, so that the tangent is increasing
    return increasing([](double at) { return sine_at(at) / cosine_at(at); }, x);
  return Interval::everything(Decoration::partial);
}

Interval asin(const Interval& x) {
  const auto at = [](double v) { return around(portable::asin(v), kArcError); };
  return increasing(at, in_unit_range(x));
}
Interval acos(const Interval& x) {
  const Interval in = in_unit_range(x);
  if (in.is_empty()) return in;
  const auto at = [](double v) { return v == 1 ? Interval(0.0) : around(portable::acos(v), kArcError); };
  return {std::max(0.0, at(in.upper).lower), at(in.lower).upper, in.decoration};
}
Interval atan(const Interval& x) { return increasing(arc_tangent_at, x); }

Interval atan2(const Interval& y, const Interval& x) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  const bool origin = x.holds(0) && y.holds(0), branch_cut = x.lower < 0 && y.lower < 0 && y.upper >= 0;
  const bool bounded = std::isfinite(x.width()) && std::isfinite(y.width());
  if (origin || branch_cut || !bounded) {
    // Bound the angle by the quadrants that the box of (x, y) can reach.
    const double left = kPiInterval.upper, right = x.lower < 0 ? left : y.upper > 0 ? kHalfPi.upper : 0;
    const double from = y.lower >= 0 ? 0 : x.lower < 0 ? -left : -kHalfPi.upper;
    return {from, right, weaker(weaker(x, y), Decoration::defined)};
  }
  // The angle is monotonic in x and in y, so its minimum and maximum are at corners of the box.
  const Interval corners[4] = {arc_at(y.lower, x.lower), arc_at(y.lower, x.upper), arc_at(y.upper, x.lower),
                               arc_at(y.upper, x.upper)};
  Interval all = corners[0];
  for (const Interval& corner : corners) all = hull(all, corner);
  all.decoration = weaker(x, y);
  return all;
}

Interval exp(const Interval& x) { return increasing(exponential_at, x); }
Interval log(const Interval& x) {
  if (!(x.upper > 0)) return Interval::empty();
  return {logarithm_at(std::max(x.lower, 0.0)).lower, logarithm_at(x.upper).upper,
          x.lower > 0 ? x.decoration : Decoration::partial};
}
Interval log10(const Interval& x) {
  constexpr double kLogarithmOf10 = 2.302585092994045684;
  return log(x) / Interval(next_down(kLogarithmOf10), next_up(kLogarithmOf10));
}

Interval sinh(const Interval& x) {
  const auto at = [](double v) {
    if (v == 0 || std::isinf(v)) return v == 0 ? Interval(0.0) : Interval(v, v);
    const Interval e = exponential_at(v);
    return (e - Interval(1.0) / e) * Interval(0.5);
  };
  return increasing(at, x);
}
Interval cosh(const Interval& x) {
  const Interval e = exp(magnitude(x));
  const auto at = [](const Interval& v) { return (v + Interval(1.0) / v) * Interval(0.5); };
  if (e.is_empty()) return e;
  return {std::max(1.0, at({e.lower, e.lower}).lower), at({e.upper, e.upper}).upper, x.decoration};
}
Interval tanh(const Interval& x) {
  const auto at = [](double v) {
    if (v == 0) return Interval(0.0);
    const Interval t = Interval(1.0) - Interval(2.0) / (exponential_at(2 * v) + Interval(1.0));
    return Interval(std::max(t.lower, -1.0), std::min(t.upper, 1.0));
  };
  return increasing(at, x);
}

Interval pow(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  if (y.is_number() && y.lower == std::nearbyint(y.lower) && std::fabs(y.lower) <= 1024) {
    Interval power = integer_power(x, static_cast<int>(y.lower));
    power.decoration = weaker(power.decoration, weaker(x, y));
    return power;
  }
  // Powers of negative numbers are defined for integer exponents only.
  if (x.lower < 0 && !y.is_number()) return Interval::everything(Decoration::partial);
  if (x.upper < 0) return Interval::empty();
  if (x.upper == 0)
    return y.lower > 0 ? Interval(0, 0, x.lower < 0 ? Decoration::partial : weaker(x, y))
                       : Interval(0, kInfinity, Decoration::partial);
  const Interval logarithms(logarithm_at(std::max(x.lower, 0.0)).lower, logarithm_at(x.upper).upper);
  Interval power = exp(y * logarithms);
  power.decoration = x.lower > 0 || (x.lower == 0 && y.lower > 0) ? weaker(x, y) : Decoration::partial;
  return power;
}

Interval wrapped(const Interval& angle) {
  if (angle.is_empty()) return angle;
  const Interval revolutions = angle / kTwoPi - Interval(0.5);
  const double first = std::ceil(revolutions.lower), last = std::ceil(revolutions.upper);
  if (first != last) return {-kPiInterval.upper, kPiInterval.upper, weaker(angle.decoration, Decoration::defined)};
  return angle - Interval(first) * kTwoPi;
}

namespace {

/// Decoration of a function with a constant value, given that of its arguments: continuous, unless they may be
/// undefined.
Decoration decoration_of_constant(Decoration known) {
  return known == Decoration::partial ? known : Decoration::continuous;
}

/// Result of a logical function: 1 if `yes` (true for all arguments), 0 if `no` (false for all), otherwise [0, 1].
Interval truth_value(bool yes, bool no, Decoration known) {
  if (yes || no) return {yes ? 1.0 : 0.0, yes ? 1.0 : 0.0, decoration_of_constant(known)};
  return {0, 1, weaker(known, Decoration::defined)};
}

}  // namespace

Interval less(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return truth_value(x.upper < y.lower, x.lower >= y.upper, weaker(x, y));
}
Interval less_or_equal(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return truth_value(x.upper <= y.lower, x.lower > y.upper, weaker(x, y));
}
Interval equal(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  const bool same = x.is_number() && y.is_number() && x.lower == y.lower;
  return truth_value(same, x.upper < y.lower || x.lower > y.upper, weaker(x, y));
}
Interval truth(const Interval& x) {
  if (x.is_empty()) return x;
  return truth_value(!x.holds(0), x.lower == 0 && x.upper == 0, x.decoration);
}

Interval choose(const Interval& condition, const Interval& x, const Interval& y) {
  const Interval first = truth(condition);
  if (first.is_empty()) return first;
  const Decoration known = decoration_of_constant(condition.decoration);
  if (first.is_number()) {
    Interval chosen = first.lower != 0 ? x : y;
    chosen.decoration = weaker(chosen.decoration, known);
    return chosen;
  }
  Interval both = hull(x, y);
  both.decoration = weaker(both.decoration, weaker(known, Decoration::defined));
  return both;
}

}  // namespace pkm
