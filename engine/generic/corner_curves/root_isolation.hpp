// Isolation of all real roots of a Chebyshev series in [-1, 1] by bisection (J. P. Boyd, "Computing real roots of a
// polynomial in Chebyshev series form through subdivision", Applied Numerical Mathematics 56, 2006).
//
// A subinterval has no root if |c[0]| exceeds the sum of the other |c[k]|, and at most one if the same holds
// for the derivative. The error of the series (interpolation and rounding) is part of these comparisons, so every root
// of the function itself is isolated, or lies in an interval that is reported as undecided: around roots of even order,
// and where roots are closer to each other than the error resolves.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/generic/corner_curves/chebyshev.hpp"

namespace pkm::generic::corner_curves {

/// If a root is closer to -1 or 1 than this, it counts as lying at this end of the interval.
inline constexpr double kAtEnd = 1e-11;

struct Root {
  double at;
  /// 0: there is a simple root at `at`; otherwise the length of an interval with the centre `at` whose number of roots
  /// is unknown.
  double width = 0;
};

/// Error bound of the interpolant of a function: interpolation error, estimated from the last coefficients, and
/// rounding errors.
/// @param rounding  bound of the rounding errors of the interpolated values
inline double interpolation_error(const Samples& coefficients, double rounding) {
  double tail = 0;
  for (std::size_t k = kNodes - 4; k < kNodes; ++k) tail = std::max(tail, std::fabs(coefficients[k]));
  return 4 * tail + rounding;
}

/// Finds the roots in [-1, 1] of a Chebyshev series, in ascending order. A root at the common end of two subintervals
/// may be reported twice.
/// @param error  upper bound of the error of the series
/// @param roots  receives the roots; must be empty
void isolate_roots(const Samples& coefficients, double error, std::vector<Root>& roots);

}  // namespace pkm::generic::corner_curves
