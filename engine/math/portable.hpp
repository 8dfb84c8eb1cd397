// Elementary functions with bit-identical results on every processor.
//
// glibc selects variants of sin, cos, exp, log and pow with fused multiply-add at run time. As a consequence, about one
// call in 1500 differs in the last bit between two processors. The results stored in a study must be reproducible on
// any machine. Therefore they are computed with the functions of this file: argument reduction and truncated power
// series in IEEE operations in a fixed order (the build disables contraction). The truncation error is below 1e-17, and
// the total error below 3 ulp (sin, cos: below 1.5 * 2^-53 absolute), as measured by the tests.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace pkm {

inline constexpr double kPi = 3.141592653589793238462643383279502884;

/// Sine and cosine of one angle.
template <class S>
struct SinCosOf {
  S sin, cos;
};

namespace portable {

/// Sine and cosine of an angle [rad], |angle| <= 1e5. Cody-Waite argument reduction with pi/2 in three parts, whose
/// leading products are exact in this range.
inline SinCosOf<double> sincos(double angle) {
  constexpr double part_1 = 0x1.921fb544p+0, part_2 = 0x1.0b4611a6p-34, part_3 = 0x1.3198a2e037073p-69;
  const double k = std::nearbyint(angle * (2 / kPi));
  const double r = ((angle - k * part_1) - k * part_2) - k * part_3;
  const double q = r * r;
  // sin r = r - r^3/3! + ..., cos r = 1 - r^2/2! + ... with |r| <= pi/4
  const double s =
      r + r * q *
              (-1.0 / 6 +
               q * (1.0 / 120 + q * (-1.0 / 5040 +
                                     q * (1.0 / 362880 + q * (-1.0 / 39916800 + q * (1.0 / 6227020800.0 +
                                                                                     q * (-1.0 / 1307674368000.0)))))));
  const double tail =
      q * q *
      (1.0 / 24 +
       q * (-1.0 / 720 +
            q * (1.0 / 40320 + q * (-1.0 / 3628800 + q * (1.0 / 479001600.0 + q * (-1.0 / 87178291200.0 +
                                                                                   q * (1.0 / 20922789888000.0)))))));
  const double half = 0.5 * q, head = 1.0 - half;
  const double c = head + (((1.0 - head) - half) + tail);  // compensates for the rounding error of 1 - q/2
  // The quadrant k mod 4: the last bits of k + 1.5 2^52 are those of k. Unlike a conversion to an integer, this is also
  // defined for NaN.
  switch (std::bit_cast<std::uint64_t>(k + 0x1.8p52) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

inline double sin(double angle) { return sincos(angle).sin; }
inline double cos(double angle) { return sincos(angle).cos; }

/// Arctangent, in [-pi/2, pi/2].
inline double atan(double x) {
  // Argument reduction in two steps: to |t| <= 1 by atan x = pi/2 - atan 1/x, then to |t| <= tan(pi/24) by subtracting
  // k pi/12, k = 0..3.
  static constexpr double tangent[4] = {0, 0.26794919243112270647, 0.57735026918962576451, 1.0};
  static constexpr double angle[4] = {0, 0.26179938779914943654, 0.52359877559829887308, 0.78539816339744830962};
  static constexpr double correction[4] = {0, -2.6802044161277e-17, -5.3604088322554e-17, 3.0616169978684e-17};
  const double magnitude = std::fabs(x);
  const bool inverse = magnitude > 1.0;
  const double t = inverse ? 1.0 / magnitude : magnitude;
  const int k = t < 0.13165249758739585347 ? 0 : t < 0.41421356237309504880 ? 1 : t < 0.76732698797896034292 ? 2 : 3;
  const double r = k == 0 ? t : (t - tangent[k]) / (1.0 + t * tangent[k]);
  const double q = r * r;
  double sum = 1.0 / 21;
  for (int n = 19; n >= 3; n -= 2) sum = 1.0 / n - q * sum;
  double result = angle[k] + (correction[k] + (r - r * q * sum));
  if (inverse) result = kPi / 2 - (result - 6.123233995736766e-17);
  return x < 0 ? -result : result;
}

/// Angle of the point (x, y), in [-pi, pi]; 0 for (0, 0).
inline double atan2(double y, double x) {
  if (x == 0 && y == 0) return 0;
  if (std::fabs(y) > std::fabs(x)) return (y > 0 ? kPi / 2 : -kPi / 2) - atan(x / y);
  const double a = atan(y / x);
  if (x > 0) return a;
  return y < 0 ? a - kPi : a + kPi;
}

/// Arcsine of a value in [-1, 1] (NaN outside), in [-pi/2, pi/2].
inline double asin(double x) { return atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }

/// Arccosine of a value in [-1, 1] (NaN outside), in [0, pi].
inline double acos(double x) { return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }

/// e^x; 0 below -745, infinity above 709.78.
inline double exp(double x) {
  if (!(x > -745.2)) return x != x ? x : 0.0;
  if (x > 709.782712893384) return std::numeric_limits<double>::infinity();
  constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
  const double k = std::nearbyint(x * 1.44269504088896340736);
  const double r = (x - k * ln2_high) - k * ln2_low;
  double sum = 1.0 / 6227020800.0;  // coefficient of the highest power of the series: 1/13!
  for (const double inverse : {1.0 / 479001600.0, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                               1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5})
    sum = inverse + r * sum;
  return std::ldexp(1.0 + (r + r * r * sum), static_cast<int>(k));
}

/// Natural logarithm of x > 0 (NaN below 0, -infinity at 0).
inline double log(double x) {
  if (!(x > 0)) return x == 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  if (x == std::numeric_limits<double>::infinity()) return x;
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // mantissa of x, in [0.5, 1)
  if (m < 0.70710678118654752440) {
    m *= 2;
    --exponent;
  }
  // log m = 2 artanh s = 2 (s + s^3/3 + ...), s = (m - 1)/(m + 1), |s| <= 0.1716
  const double f = m - 1.0, s = f / (m + 1.0), q = s * s;
  double sum = 1.0 / 21;
  for (int n = 19; n >= 3; n -= 2) sum = 1.0 / n + q * sum;
  constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
  // 2 s is computed as f - s f, because f is exact
  return exponent * ln2_high + (f - (s * (f - 2.0 * q * sum) - exponent * ln2_low));
}

/// x^y for x >= 0: e^(y log x). Relative error about |y log x| 2^-53.
inline double pow(double x, double y) {
  if (x == 0) return y == 0 ? 1.0 : 0.0;
  return exp(y * log(x));
}

}  // namespace portable
}  // namespace pkm
