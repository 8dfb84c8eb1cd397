#include "engine/math/interval.hpp"

#include "engine/math/portable.hpp"

// Bounds of the errors of portable.hpp, with u = 2^-53, so that a rounding to r makes an error of at most u |r|, and of
// half of u for |r| <= 1/2. Each is at least twice what the derivation gives.
//
// sin, cos. k pi/2 is subtracted in three parts of 33 bits and the rest; with |k| < 2^17 the first two products are
// exact, the first difference is exact too (Sterbenz), the others round to |r| < 0.79: u/2 each, and what is missing of
// pi/2 is below 2^-100. So r is off by less than 1.1 u, or not at all for k = 0. The series end before r^17/17! <
// 0.45 u, and r^18/18!. sin: r + r q S with |r q S| < 0.09, in which every factor is off by a few u: below 0.7 u; the
// sum rounds by u/2. Together 2.8 u. cos: 1 - q/2 keeps what it rounds away; q/2 < 0.31 is off by 0.31 u, the tail
// below 0.02 by a few u of it, the sum by u/2, and r's error counts 0.71 times: 1.8 u. Both: 4 u = 2^-51. For k = 0, r
// is exact, and sin r = r (1 + e) with |e| < (0.11 * 6 + 1 + 0.45 * 0.11) u < 2 u, relative.
//
// atan. t rounds by u/2; the table's tangents are off by u/2, and t - tangent rounds by u/4; 1 + t tangent is off by
// 1.5 u relative and the quotient rounds by 1 u relative, of |r| < 0.132: 0.4 u; the series ends before r^23/23 <
// 1e-21; its tail is below 0.001. angle + (..) rounds by u/2. Where the argument was inverted: pi/2 - (..) rounds by
// u/2 and u. Together 3.7 u, of which half of the room is left in 2^-50 = 8 u. For |x| < 0.13, r is exact, and what is
// relative of the error is below 2 u.
//
// atan2. The quotient is off by u relative, which turns by at most u/2; atan by 3.7 u; pi, pi/2 are off by 1.2 u, and
// the sum, up to pi, rounds by 2 u: 7.4 u. asin, acos: (1 - x)(1 + x) is off by 3 u relative, its root by 2.5 u, which
// turns by at most 1.3 u: 8.7 u. All: 2^-48 = 32 u.
//
// exp. x - k ln2_high is exact (both are multiples of x's last bit, and the difference is below 0.35), k ln2_low is
// below 2e-7, the difference rounds by u/4. The series ends before r^14/14! < 0.1 u; 1 + (r + r^2 s) is off by
// (1 + 3 * 0.35) u: less than 2.6 u of a value of 0.7 and more: 3.7 u relative, and the smallest number where the
// result has fewer digits. log. f = m - 1 is exact. The correction of f is below 0.2 |f| and off by 6 u relative: 1.2 u
// of |f|; the sums round by u of |f| each; |log m| > 0.83 |f|: below 5 u relative for exponent 0. Else |log x| > 0.34,
// the product with ln2_high is exact, that with ln2_low negligible, the terms of |f| < 0.42 are off by 3.2 u |f|, and
// the sum rounds by u: below 5 u relative. Both: 2^-49 = 16 u.
namespace pkm {
namespace {

using rounding::product_down, rounding::product_up, rounding::quotient_down, rounding::quotient_up, rounding::sum_down,
    rounding::sum_up;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kArcError = 0x1p-48;
constexpr double kExponentialError = 0x1p-49;

// The double kPi is less than pi.
const Interval kHalfTurn{kPi, next_up(kPi)}, kTurn{2 * kPi, next_up(2 * kPi)}, kQuarterTurn{kPi / 2, next_up(kPi / 2)};

Interval around(double value, double error) { return {sum_down(value, -error), sum_up(value, error)}; }

Interval sine_at(double x) {
  const double s = portable::sin(x);
  return around(s, std::fabs(x) <= 0.78 ? std::fabs(s) * 0x1p-51 : 0x1p-51);
}
Interval cosine_at(double x) { return x == 0 ? Interval(1) : around(portable::cos(x), 0x1p-51); }
Interval arc_tangent_at(double x) {
  if (std::isinf(x)) return x < 0 ? -kQuarterTurn : kQuarterTurn;
  const double a = portable::atan(x);
  return around(a, std::fabs(x) <= 0.13 ? std::fabs(a) * 0x1p-51 : 0x1p-50);
}
Interval exponential_at(double x) {
  if (x == 0) return {1.0};
  if (std::isinf(x)) return x < 0 ? Interval(0) : Interval(std::numeric_limits<double>::max(), kInfinity);
  const double e = portable::exp(x);
  if (e == kInfinity) return {std::numeric_limits<double>::max() / 2, kInfinity};
  // below the normal numbers, ldexp rounds to the next one
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

/// From the values at the ends of a function that grows.
template <class F>
Interval growing(const F& at, const Interval& x) {
  if (x.is_empty()) return x;
  return {at(x.lower).lower, at(x.upper).upper, x.regularity};
}

/// Whether a whole number of turns and `offset` of one may be in x.
bool may_hold_turn(const Interval& x, double offset) {
  const Interval turns = x / kTurn - Interval(offset);
  return std::ceil(turns.lower) <= turns.upper;
}

/// Sine or cosine, which are 1 at `top` turns and -1 half a turn from there.
template <class F>
Interval wave(const F& at, const Interval& x, double top) {
  if (x.is_empty()) return x;
  if (!(std::max(-x.lower, x.upper) <= 1e5)) return {-1, 1, x.regularity};
  const Interval a = at(x.lower), b = at(x.upper);
  const double lower = may_hold_turn(x, top + 0.5) ? -1 : std::max(-1.0, std::min(a.lower, b.lower));
  const double upper = may_hold_turn(x, top) ? 1 : std::min(1.0, std::max(a.upper, b.upper));
  return {lower, upper, x.regularity};
}

/// x^n, n >= 0, of x >= 0.
Interval whole_power(Interval x, int n) {
  Interval result(1.0);
  for (; n > 0; n /= 2, x = square(x))
    if (n % 2 != 0) result = result * x;
  return result;
}
Interval whole_power_of_any(const Interval& x, int n) {
  if (n < 0) return Interval(1.0) / whole_power_of_any(x, -n);
  if (n % 2 == 0 || x.lower >= 0) return whole_power(magnitude(x), n);
  if (x.upper <= 0) return -whole_power(-x, n);
  return {-whole_power({0, -x.lower}, n).upper, whole_power({0, x.upper}, n).upper, x.regularity};
}

/// x in [-1, 1], or what of it is.
Interval in_unit_range(const Interval& x) {
  if (!(x.lower <= 1 && x.upper >= -1)) return Interval::empty();
  if (x.lower >= -1 && x.upper <= 1) return x;
  return {std::max(x.lower, -1.0), std::min(x.upper, 1.0), Regularity::partial};
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
  const Regularity known = worse(x, y);
  if (y.upper <= 0) return -x / -y;
  if (y.lower < 0) return Interval::everything(Regularity::partial);
  if (y.lower == 0) {
    if (x.lower >= 0) return {quotient_down(x.lower, y.upper), kInfinity, Regularity::partial};
    if (x.upper <= 0) return {-kInfinity, quotient_up(x.upper, y.upper), Regularity::partial};
    return Interval::everything(Regularity::partial);
  }
  return {quotient_down(x.lower, x.lower >= 0 ? y.upper : y.lower),
          quotient_up(x.upper, x.upper >= 0 ? y.lower : y.upper), known};
}

Interval hull(const Interval& x, const Interval& y) {
  if (x.is_empty()) return y.is_empty() ? y : Interval(y.lower, y.upper, Regularity::partial);
  if (y.is_empty()) return {x.lower, x.upper, Regularity::partial};
  return {std::min(x.lower, y.lower), std::max(x.upper, y.upper), worse(x, y)};
}

Interval magnitude(const Interval& x) {
  if (x.is_empty() || x.lower >= 0) return x;
  if (x.upper <= 0) return -x;
  return {0, std::max(-x.lower, x.upper), x.regularity};
}

Interval sign(const Interval& x) {
  if (x.is_empty()) return x;
  const auto of = [](double v) { return v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0; };
  const bool known = of(x.lower) == of(x.upper);
  return {of(x.lower), of(x.upper), known ? x.regularity : worse(x.regularity, Regularity::defined)};
}

Interval min(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return {std::min(x.lower, y.lower), std::min(x.upper, y.upper), worse(x, y)};
}
Interval max(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return {std::max(x.lower, y.lower), std::max(x.upper, y.upper), worse(x, y)};
}

Interval sin(const Interval& x) { return wave(sine_at, x, 0.25); }
Interval cos(const Interval& x) { return wave(cosine_at, x, 0); }

Interval tan(const Interval& x) {
  const Interval c = cos(x);
  if (x.is_empty() || !c.holds(0))  // no pole between the ends, so that it grows
    return growing([](double at) { return sine_at(at) / cosine_at(at); }, x);
  return Interval::everything(Regularity::partial);
}

Interval asin(const Interval& x) {
  const auto at = [](double v) { return around(portable::asin(v), kArcError); };
  return growing(at, in_unit_range(x));
}
Interval acos(const Interval& x) {
  const Interval in = in_unit_range(x);
  if (in.is_empty()) return in;
  const auto at = [](double v) { return v == 1 ? Interval(0.0) : around(portable::acos(v), kArcError); };
  return {std::max(0.0, at(in.upper).lower), at(in.lower).upper, in.regularity};
}
Interval atan(const Interval& x) { return growing(arc_tangent_at, x); }

Interval atan2(const Interval& y, const Interval& x) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  const bool origin = x.holds(0) && y.holds(0), jump = x.lower < 0 && y.lower < 0 && y.upper >= 0;
  const bool bounded = std::isfinite(x.width()) && std::isfinite(y.width());
  if (origin || jump || !bounded) {
    // by quadrants
    const double left = kHalfTurn.upper, right = x.lower < 0 ? left : y.upper > 0 ? kQuarterTurn.upper : 0;
    const double from = y.lower >= 0 ? 0 : x.lower < 0 ? -left : -kQuarterTurn.upper;
    return {from, right, worse(worse(x, y), Regularity::defined)};
  }
  // Along either axis the angle grows or falls, so the corners have the least and the greatest.
  const Interval corners[4] = {arc_at(y.lower, x.lower), arc_at(y.lower, x.upper), arc_at(y.upper, x.lower),
                               arc_at(y.upper, x.upper)};
  Interval all = corners[0];
  for (const Interval& corner : corners) all = hull(all, corner);
  all.regularity = worse(x, y);
  return all;
}

Interval exp(const Interval& x) { return growing(exponential_at, x); }
Interval log(const Interval& x) {
  if (!(x.upper > 0)) return Interval::empty();
  return {logarithm_at(std::max(x.lower, 0.0)).lower, logarithm_at(x.upper).upper,
          x.lower > 0 ? x.regularity : Regularity::partial};
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
  return growing(at, x);
}
Interval cosh(const Interval& x) {
  const Interval e = exp(magnitude(x));
  const auto at = [](const Interval& v) { return (v + Interval(1.0) / v) * Interval(0.5); };
  if (e.is_empty()) return e;
  return {std::max(1.0, at({e.lower, e.lower}).lower), at({e.upper, e.upper}).upper, x.regularity};
}
Interval tanh(const Interval& x) {
  const auto at = [](double v) {
    if (v == 0) return Interval(0.0);
    const Interval t = Interval(1.0) - Interval(2.0) / (exponential_at(2 * v) + Interval(1.0));
    return Interval(std::max(t.lower, -1.0), std::min(t.upper, 1.0));
  };
  return growing(at, x);
}

Interval pow(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  if (y.is_number() && y.lower == std::nearbyint(y.lower) && std::fabs(y.lower) <= 1024) {
    Interval power = whole_power_of_any(x, static_cast<int>(y.lower));
    power.regularity = worse(power.regularity, worse(x, y));
    return power;
  }
  // of negative numbers there are powers for whole exponents alone
  if (x.lower < 0 && !y.is_number()) return Interval::everything(Regularity::partial);
  if (x.upper < 0) return Interval::empty();
  if (x.upper == 0)
    return y.lower > 0 ? Interval(0, 0, x.lower < 0 ? Regularity::partial : worse(x, y))
                       : Interval(0, kInfinity, Regularity::partial);
  const Interval logarithms(logarithm_at(std::max(x.lower, 0.0)).lower, logarithm_at(x.upper).upper);
  Interval power = exp(y * logarithms);
  power.regularity = x.lower > 0 || (x.lower == 0 && y.lower > 0) ? worse(x, y) : Regularity::partial;
  return power;
}

Interval wrapped(const Interval& angle) {
  if (angle.is_empty()) return angle;
  const Interval turns = angle / kTurn - Interval(0.5);
  const double first = std::ceil(turns.lower), last = std::ceil(turns.upper);
  if (first != last) return {-kHalfTurn.upper, kHalfTurn.upper, worse(angle.regularity, Regularity::defined)};
  return angle - Interval(first) * kTurn;
}

namespace {

/// Of what is one number wherever it is defined.
Regularity undefined_or_constant(Regularity known) {
  return known == Regularity::partial ? known : Regularity::continuous;
}

/// Of a question that is answered with yes, with no, or with neither.
Interval answer(bool yes, bool no, Regularity known) {
  if (yes || no) return {yes ? 1.0 : 0.0, yes ? 1.0 : 0.0, undefined_or_constant(known)};
  return {0, 1, worse(known, Regularity::defined)};
}

}  // namespace

Interval less(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return answer(x.upper < y.lower, x.lower >= y.upper, worse(x, y));
}
Interval less_or_equal(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  return answer(x.upper <= y.lower, x.lower > y.upper, worse(x, y));
}
Interval equal(const Interval& x, const Interval& y) {
  if (x.is_empty() || y.is_empty()) return Interval::empty();
  const bool same = x.is_number() && y.is_number() && x.lower == y.lower;
  return answer(same, x.upper < y.lower || x.lower > y.upper, worse(x, y));
}
Interval truth(const Interval& x) {
  if (x.is_empty()) return x;
  return answer(!x.holds(0), x.lower == 0 && x.upper == 0, x.regularity);
}

Interval choose(const Interval& condition, const Interval& x, const Interval& y) {
  const Interval first = truth(condition);
  if (first.is_empty()) return first;
  const Regularity known = undefined_or_constant(condition.regularity);
  if (first.is_number()) {
    Interval chosen = first.lower != 0 ? x : y;
    chosen.regularity = worse(chosen.regularity, known);
    return chosen;
  }
  Interval both = hull(x, y);
  both.regularity = worse(both.regularity, worse(known, Regularity::defined));
  return both;
}

}  // namespace pkm
