// What the steps of a formula do, in the vocabulary of scalar.hpp: for double and for the derivative scalars.
#pragma once

#include <cmath>
#include <limits>

#include "engine/math/dual.hpp"
#include "engine/math/formula_program.hpp"
#include "engine/math/taylor.hpp"

namespace pkm::formula {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline bool is_constant(double) { return true; }
template <int N>
bool is_constant(const Dual<N>& x) {
  for (int i = 0; i < N; ++i)
    if (x.v[i] != 0) return false;
  return true;
}
inline bool is_constant(const Taylor& x) { return x.d == 0 && x.dd == 0; }

/// The portable sine and cosine reduce angles up to 1e5 rad.
template <class S>
SinCosOf<S> sine_and_cosine(const S& angle) {
  if (!(std::fabs(value_of(angle)) <= 1e5)) return {S(kNaN), S(kNaN)};
  return sincos(angle);
}

/// x^n by squaring: as many roundings as multiplications.
template <class S>
S whole_power(S x, int n) {
  if (n < 0) return 1.0 / whole_power(x, -n);
  S result(1.0);
  for (bool first = true; n > 0; n /= 2, x = x * x)
    if (n % 2) {
      result = first ? x : result * x;
      first = false;
    }
  return result;
}

template <class S>
S power(const S& x, const S& y) {
  const double base = value_of(x), exponent = value_of(y);
  if (exponent == std::nearbyint(exponent) && std::fabs(exponent) <= 1024) {
    S result = whole_power(x, static_cast<int>(exponent));
    // An exponent that varies adds derivatives, but no value: e^0 is 1.
    if (!is_constant(y) && base > 0) result = result * exp(S((y - exponent) * log(x)));
    return result;
  }
  if (base > 0) return exp(S(y * log(x)));
  if (base == 0 && exponent > 0) return S(0.0);
  if (base == 0 && exponent < 0) return S(std::numeric_limits<double>::infinity());
  return S(kNaN);
}

template <class S>
S hyperbolic_sine(const S& x) {
  if (std::fabs(value_of(x)) > 0.5) {
    const S e = exp(x);
    return (e - 1.0 / e) * 0.5;
  }
  // x + x^3/3! + ... + x^13/13!; e^x - e^-x would lose digits
  const S q = x * x;
  S sum = q * (1.0 / 156) + 1.0;
  for (const double inverse : {1.0 / 110, 1.0 / 72, 1.0 / 42, 1.0 / 20, 1.0 / 6}) sum = q * inverse * sum + 1.0;
  return x * sum;
}

template <class S>
S hyperbolic_cosine(const S& x) {
  const S e = exp(x);
  return (e + 1.0 / e) * 0.5;
}

template <class S>
S hyperbolic_tangent(const S& x) {
  if (std::fabs(value_of(x)) <= 0.5) return hyperbolic_sine(x) / hyperbolic_cosine(x);
  if (value_of(x) < 0) return -hyperbolic_tangent(S(-x));
  return 1.0 - 2.0 / (exp(S(x * 2.0)) + 1.0);
}

/// 1 or 0; NaN when something undefined was asked for.
inline double truth(bool known, bool holds) { return known ? (holds ? 1.0 : 0.0) : kNaN; }

/// The value of an operation on x[0], ..., x[count - 1].
template <class S>
S apply(Operation operation, const S* x, std::size_t count) {
  const double a = value_of(x[0]), b = count > 1 ? value_of(x[1]) : 0;
  const bool known = a == a && b == b;
  switch (operation) {
    case Operation::negate:
      return -x[0];
    case Operation::add:
      return x[0] + x[1];
    case Operation::subtract:
      return x[0] - x[1];
    case Operation::multiply:
      return x[0] * x[1];
    case Operation::divide:
      return x[0] / x[1];
    case Operation::power:
      return power(x[0], x[1]);
    case Operation::less:
      return S(truth(known, a < b));
    case Operation::less_or_equal:
      return S(truth(known, a <= b));
    case Operation::greater:
      return S(truth(known, a > b));
    case Operation::greater_or_equal:
      return S(truth(known, a >= b));
    case Operation::equal:
      return S(truth(known, a == b));
    case Operation::unequal:
      return S(truth(known, a != b));
    case Operation::both:
      return S(truth(known, a != 0 && b != 0));
    case Operation::either:
      return S(truth(known, a != 0 || b != 0));
    case Operation::sine:
      return sine_and_cosine(x[0]).sin;
    case Operation::cosine:
      return sine_and_cosine(x[0]).cos;
    case Operation::tangent: {
      const auto [sine, cosine] = sine_and_cosine(x[0]);
      return sine / cosine;
    }
    case Operation::arcsine:
      return asin(x[0]);
    case Operation::arccosine:
      return acos(x[0]);
    case Operation::arctangent:
      return atan2(x[0], S(1.0));
    case Operation::arctangent_2:
      return atan2(x[0], x[1]);
    case Operation::hyperbolic_sine:
      return hyperbolic_sine(x[0]);
    case Operation::hyperbolic_cosine:
      return hyperbolic_cosine(x[0]);
    case Operation::hyperbolic_tangent:
      return hyperbolic_tangent(x[0]);
    case Operation::exponential:
      return exp(x[0]);
    case Operation::logarithm:
      return log(x[0]);
    case Operation::logarithm_10:
      return log(x[0]) / 2.302585092994045684;
    case Operation::root:
      return sqrt(x[0]);
    case Operation::magnitude:
      return a < 0 ? S(-x[0]) : x[0];
    case Operation::sign:
      return S(a > 0 ? 1.0 : a < 0 ? -1.0 : a);
    case Operation::least:
    case Operation::greatest: {
      S best = x[0];
      for (std::size_t i = 1; i < count; ++i) {
        const double next = value_of(x[i]), so_far = value_of(best);
        const bool better = operation == Operation::least ? next < so_far : next > so_far;
        if (better || next != next) best = x[i];
        if (next != next) break;
      }
      return best;
    }
    default:
      return S(kNaN);  // the other operations are the stack's
  }
}

}  // namespace pkm::formula
