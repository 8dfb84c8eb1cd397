// Volume of the slices of a segment, and its derivatives by the curves: adaptive Gauss-Kronrod quadrature of every
// corner curve over the ranges in which it is active (decomposition.hpp).
//
// At an end where the discriminant vanishes, the crossing behaves like a square root; the variable transformation of
// math/quadrature.hpp makes the integrand analytic there. A range is therefore integrated with few nodes, whatever
// happens to other crossings.
#pragma once

#include "engine/generic/corner_curves/decomposition.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::corner_curves {

/// The outer coordinate as a function of tau, t = low + (high - low) phi((tau + 1)/2), with the transformation phi of
/// math/quadrature.hpp at ends where the curves behave like square roots.
using OuterRange = Subinterval<double>;

/// The derivative of the outer coordinate by tau.
inline double outer_derivative(const OuterRange& range, double tau) {
  return 0.5 * map_node(range, 0.5 * (tau + 1)).jacobian;
}

/// A subinterval of an active range.
struct RangeCell {
  std::uint32_t range;
  Subinterval<double> interval;  ///< subinterval of tau
  double value, error, size;     ///< size: integral of the magnitude
};

/// A segment of the outer coordinate.
struct SegmentIntegral {
  OuterRange outer;
  std::vector<BoundaryCurve> curves;
  Decomposition decomposition;
  std::vector<RangeCell> cells;
  Integral<double> area{};  ///< integral over tau, with a bound of the rounding error

  /// Integrates all ranges with one rule each.
  void start();
  /// Bisects the subinterval with the largest error. @return false if all subintervals are too short
  bool refine();
  void sum();
};

/// Derivatives of the volume with respect to the series coefficients of the functions u, w and c of a curve.
using CurveAdjoints = std::array<Samples, 3>;

/// Adds the derivatives of the integral of a segment with respect to the first coefficients of all series.
/// @param terms     number of coefficients, at least 2
/// @param adjoints  adjoints of each curve
void add_adjoints(const SegmentIntegral& segment, std::size_t terms, std::vector<CurveAdjoints>& adjoints);

}  // namespace pkm::generic::corner_curves
