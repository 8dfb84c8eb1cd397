// Volume of the slices of a segment, and its derivatives with respect to the boundary curves: adaptive Gauss-Kronrod
// quadrature of every corner curve over the ranges in which it is active (decomposition.hpp).
//
// At an end where the discriminant vanishes, the crossing behaves like a square root; the variable transformation of
// math/quadrature.hpp makes the integrand analytic there. A range is therefore integrated with few nodes, whatever
// happens to other crossings.
#pragma once

#include "engine/generic/corner_curves/decomposition.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::corner_curves {

/// The outer coordinate t as a function of tau in [-1, 1]: t = low + (high - low) phi((tau + 1)/2). phi is the
/// transformation of math/quadrature.hpp for ends of [low, high] at which the boundary curves behave like square roots.
using OuterRange = Subinterval<double>;

/// The derivative dt/dtau of the outer coordinate t with respect to tau.
inline double outer_derivative(const OuterRange& range, double tau) {
  return 0.5 * map_node(range, 0.5 * (tau + 1)).jacobian;
}

/// A crossing of two boundary curves: the point p and, of curves that are circles, its angle on the circle [rad],
/// counted from the direction of the circle's cut.
struct CrossingAt {
  Vector p{};
  double angle_on_first = 0, angle_on_second = 0;
};

/// A subinterval of an active range of tau, with the integral over it.
struct RangeCell {
  std::uint32_t range;
  Subinterval<double> interval;  ///< subinterval of tau over which the crossing is integrated
  double value, error, size;     ///< integral, estimate of its error, and integral of the integrand's magnitude
  std::array<CrossingAt, NestedRule::kNodes> crossings{};  ///< the crossing at the nodes of the quadrature rule
};

/// The integral over a segment, i.e. an interval of the outer coordinate in which the boundary curves are analytic.
struct SegmentIntegral {
  OuterRange outer;
  std::vector<BoundaryCurve> curves;
  Decomposition decomposition;
  std::vector<RangeCell> cells;
  /// Integral, over the outer coordinate, of the area of the slices in the coordinates of the frame; its error includes
  /// rounding errors.
  Integral<double> area{};

  /// Integrates over each active range by one application of the Kronrod rule.
  void start();
  /// Bisects the subinterval (cell) with the largest error.
  /// @return false if no subinterval with an error is long enough to be bisected
  bool refine();
  void sum();
};

/// Derivatives of the volume with respect to the series coefficients of the functions u, w and c of a curve, and for a
/// conic xx, xy and yy.
using CurveAdjoints = std::array<Samples, 6>;

/// Adds the derivatives of a segment's integral with respect to the first `terms` Chebyshev coefficients of all curves.
/// @param terms     a multiple of kLanes
/// @param adjoints  one element for each curve, to which the derivatives are added
void add_adjoints(const SegmentIntegral& segment, std::size_t terms, std::vector<CurveAdjoints>& adjoints);

}  // namespace pkm::generic::corner_curves
