// Taylor coefficients as intervals: c[k] contains f^(k)(x) / k! for all x of the interval in which the variable lies.
// With a single number as this interval, c are the coefficients at a point, enclosed with their rounding errors.
//
// The integral of f over [m - h, m + h] is the sum of the terms 2 c[k] h^(k+1) / (k+1), k = 0, 2, .., of the
// coefficients at m, where the last one, of even order, is that of the whole interval (R. E. Moore, "Interval
// Analysis", Prentice-Hall 1966, chapter 8).
#pragma once

#include <array>

#include "engine/math/interval.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm::generic::edges {

/// Taylor coefficients of a function up to order N, as intervals.
template <std::size_t N>
struct IntervalSeries {
  std::array<Interval, N + 1> c{};

  IntervalSeries() = default;
  IntervalSeries(double constant) { c[0] = constant; }           // implicit, for formulas that mix series and constants
  IntervalSeries(const Interval& constant) { c[0] = constant; }  // implicit, for formulas that mix series and constants
  /// The series of the variable x itself; x is a number or an interval.
  static IntervalSeries variable(const Interval& x) {
    IntervalSeries series(x);
    if constexpr (N > 0) series.c[1] = 1;
    return series;
  }

  friend IntervalSeries operator+(IntervalSeries x, const IntervalSeries& y) {
    for (std::size_t k = 0; k <= N; ++k) x.c[k] += y.c[k];
    return x;
  }
  friend IntervalSeries operator-(IntervalSeries x, const IntervalSeries& y) {
    for (std::size_t k = 0; k <= N; ++k) x.c[k] = x.c[k] - y.c[k];
    return x;
  }
  friend IntervalSeries operator*(const IntervalSeries& x, const IntervalSeries& y) {
    IntervalSeries product;
    for (std::size_t k = 0; k <= N; ++k)
      for (std::size_t j = 0; j <= k; ++j) product.c[k] += x.c[j] * y.c[k - j];
    return product;
  }
  friend IntervalSeries operator*(IntervalSeries x, const Interval& factor) {
    for (Interval& each : x.c) each = each * factor;
    return x;
  }
  // coefficients of q = x / y, from x = q y
  friend IntervalSeries operator/(const IntervalSeries& x, const IntervalSeries& y) {
    IntervalSeries q;
    for (std::size_t k = 0; k <= N; ++k) {
      q.c[k] = x.c[k];
      for (std::size_t j = 0; j < k; ++j) q.c[k] = q.c[k] - q.c[j] * y.c[k - j];
      q.c[k] = q.c[k] / y.c[0];
    }
    return q;
  }
  IntervalSeries& operator+=(const IntervalSeries& y) { return *this = *this + y; }
};

template <std::size_t N>
IntervalSeries<N> square(const IntervalSeries<N>& x) {
  IntervalSeries<N> product = x * x;
  product.c[0] = square(x.c[0]);
  return product;
}

template <std::size_t N>
IntervalSeries<N> sqrt(const IntervalSeries<N>& x) {  // coefficients of s = sqrt(x), from x = s^2
  IntervalSeries<N> s;
  s.c[0] = sqrt(x.c[0]);
  for (std::size_t k = 1; k <= N; ++k) {
    s.c[k] = x.c[k];
    for (std::size_t j = 1; j < k; ++j) s.c[k] = s.c[k] - s.c[j] * s.c[k - j];
    s.c[k] = s.c[k] / (s.c[0] * Interval(2));
  }
  return s;
}

template <std::size_t N>
struct SineCosineSeries {
  IntervalSeries<N> sine, cosine;
};
template <std::size_t N>
// coefficients of s = sin x and c = cos x, from s' = c x' and c' = -s x'
SineCosineSeries<N> sine_cosine(const IntervalSeries<N>& x) {
  SineCosineSeries<N> of;
  of.sine.c[0] = sin(x.c[0]);
  of.cosine.c[0] = cos(x.c[0]);
  for (std::size_t k = 1; k <= N; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      const Interval slope = x.c[j] * (Interval(static_cast<double>(j)) / Interval(static_cast<double>(k)));
      of.sine.c[k] += slope * of.cosine.c[k - j];
      of.cosine.c[k] = of.cosine.c[k] - slope * of.sine.c[k - j];
    }
  }
  return of;
}

/// The series of the derivative x'; its order N - 1 is lower by one than that of x.
template <std::size_t N>
IntervalSeries<N - 1> derivative(const IntervalSeries<N>& x) {
  IntervalSeries<N - 1> d;
  for (std::size_t k = 0; k < N; ++k) d.c[k] = x.c[k + 1] * Interval(static_cast<double>(k + 1));
  return d;
}
/// The series x without its coefficient of the highest order, N.
template <std::size_t N>
IntervalSeries<N - 1> truncated(const IntervalSeries<N>& x) {
  IntervalSeries<N - 1> all;
  std::copy_n(x.c.begin(), N, all.c.begin());
  return all;
}

}  // namespace pkm::generic::edges
