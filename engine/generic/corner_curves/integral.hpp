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

/// The outer coordinate t as a function of tau: t = low + (high - low) phi((tau + 1)/2). phi is the transformation of
/// math/quadrature.hpp for ends at which the curves behave like square roots.
using OuterRange = Subinterval<double>;

/// The derivative dt/dtau of the outer coordinate.
inline double outer_derivative(const OuterRange& range, double tau) {
  return 0.5 * map_node(range, 0.5 * (tau + 1)).jacobian;
}

/// A subinterval of an active range, with its integral.
struct RangeCell {
  std::uint32_t range;
  Subinterval<double> interval;  ///< subinterval of tau over which the vertices are integrated
  double value, error, size;     ///< integral, estimate of its error, and integral of the magnitude of the integrand
};

/// The integral over a segment of the outer coordinate, i.e. an interval in which the boundary curves are analytic.
struct SegmentIntegral {
  OuterRange outer;
  std::vector<BoundaryCurve> curves;
  Decomposition decomposition;
  std::vector<RangeCell> cells;
  /// Integral of the area of the slices over tau, with an error that includes rounding errors.
  Integral<double> area{};

  /// Integrates over each active range with a single Kronrod rule.
  void start();
  /// Bisects the subinterval with the largest error. @return false if all subintervals are too short to be bisected
  bool refine();
  void sum();
};

/// Derivatives of the volume with respect to the series coefficients of the functions u, w and c of a curve.
using CurveAdjoints = std::array<Samples, 3>;

/// Adds the derivatives of the integral of a segment with respect to the first coefficients of all series.
/// @param terms     number of coefficients, at least 2
/// @param adjoints  adjoints of the curves, by curve, to which the derivatives are added
void add_adjoints(const SegmentIntegral& segment, std::size_t terms, std::vector<CurveAdjoints>& adjoints);

}  // namespace pkm::generic::corner_curves
