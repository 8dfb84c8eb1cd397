// Crossings of a general conic with another curve, as functions of tau.
//
// There are up to four crossings, and no simple closed form that follows a single one. Between two consecutive roots of
// the discriminant their number is constant. There, each crossing is interpolated in homogeneous coordinates (X : Y :
// W), (x, y) = (X, Y)/W, in which crossings that pass through infinity are smooth, too.
#pragma once

#include <vector>

#include "engine/generic/corner_curves/boundary_curve.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::corner_curves {

/// Homogeneous coordinates (X, Y, W) of a point (X, Y)/W of a slice, as a vector of length 1.
using Homogeneous = std::array<double, 3>;

/// Value W^2 h((X, Y)/W) of the polynomial h of a curve, at a point in homogeneous coordinates.
double homogeneous_value(const CurveAt& curve, const Homogeneous& p);

/// Finds all real crossings of a conic with another curve. @return their number
std::size_t find_crossings(const CurveAt& conic, const CurveAt& other, std::array<Homogeneous, 4>& points);

/// Function that vanishes where two crossings (real or complex) of a conic with another curve merge.
void conic_discriminant(const BoundaryCurve& conic, const BoundaryCurve& other, Sampled& result);

/// Improves a simple root tau of conic_discriminant(): near the root, the crossings vary like the square root of the
/// distance, so that an error of the root would be magnified.
double refine_contact(const BoundaryCurve& conic, const BoundaryCurve& other, double tau);

/// Values of a curve at the nodes of a range of tau.
/// @param tau  values of tau at the nodes
void sample_curve(const BoundaryCurve& curve, const Subinterval<double>& range, const Samples& tau,
                  std::array<CurveAt, kNodes>& at);

/// One crossing of a conic with another curve, as a function of tau in `range`.
struct CrossingPath {
  Subinterval<double> range;      ///< range of tau; at an end with a square root, the crossing merges with another one
  std::array<Samples, 3> values;  ///< homogeneous coordinates X, Y and W at the nodes of map_node()
  std::array<Samples, 3> series;  ///< Chebyshev coefficients of X, Y and W in the variable of map_node()
  std::size_t terms = kNodes;
  double error = 0;  ///< interpolation error of `series`

  /// The crossing of the two curves, improved by Newton's method.
  Vector at(double tau, const CurveAt& first, const CurveAt& second) const;
};

/// Follows the crossings of a conic with another curve.
/// @param range  range in which the discriminant has no root; a square root is allowed at one end
/// @param paths  receives the crossings; a crossing for which one series is not sufficient is appended in pieces
/// @return false if the crossings are not resolved
bool follow_crossings(const BoundaryCurve& conic, const BoundaryCurve& other, const Subinterval<double>& range,
                      std::vector<CrossingPath>& paths);

}  // namespace pkm::generic::corner_curves
