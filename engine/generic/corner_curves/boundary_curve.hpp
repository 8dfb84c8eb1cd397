// Circles and lines that bound the slices of a workspace as functions of the outer coordinate, their crossings, and the
// functions that vanish where two of them touch or three meet in one point.
//
// In the plane (x, y) of a slice a boundary curve is the zero set of
//
//   h(p) = a |p|^2 + b . p + c,   circle: a = 1, b = -2 m, c = |m|^2 - s;   line: a = 0, |b| = 1
//
// with centre m, squared radius s (which may be negative: no circle), unit normal b. The three functions of a curve
// depend on one variable tau in [-1, 1] and are Chebyshev interpolants (chebyshev.hpp).
#pragma once

#include <cstdint>

#include "engine/generic/corner_curves/chebyshev.hpp"

namespace pkm::generic::corner_curves {

struct Vector {
  double x, y;
};
inline double determinant(const Vector& g, const Vector& h) { return g.x * h.y - g.y * h.x; }

/// A boundary curve of the slice at one value of tau, the variable in [-1, 1] that stands for the outer coordinate. (u,
/// w) is the centre of a circle, or the unit normal of a line; c is the squared radius of a circle, or the value of h
/// at the origin for a line.
struct CurveAt {
  bool is_circle;
  double u, w, c;

  double h(const Vector& p) const {
    if (!is_circle) return u * p.x + w * p.y + c;
    const double x = p.x - u, y = p.y - w;
    return x * x + y * y - c;
  }
  Vector gradient(const Vector& p) const { return is_circle ? Vector{2 * (p.x - u), 2 * (p.y - w)} : Vector{u, w}; }
};

/// A boundary curve of slices as a function of tau, the variable in [-1, 1] that stands for the outer coordinate.
struct BoundaryCurve {
  enum class Kind : std::uint8_t {
    circle,
    line,
    cut  ///< line through the centre of a circle and the point of the circle at which its angle is 0
  };
  Kind kind = Kind::line;
  std::array<Samples, 3> values;  ///< values of u, w and c (see CurveAt) at the Chebyshev nodes
  std::array<Samples, 3> series;  ///< Chebyshev coefficients of the functions u, w and c of tau
  /// Values at the Chebyshev nodes of the coefficients b_x, b_y and c of the curve's equation h(p) = a |p|^2 + b . p +
  /// c = 0.
  std::array<Samples, 3> equation;
  std::size_t terms = kNodes;    ///< number of leading coefficients of `series` that are in use
  double tail = 0;               ///< interpolation error of `series`, estimated from the last coefficients
  double error = 0;              ///< `tail` plus a bound of the rounding errors
  std::array<double, 3> size{};  ///< maximum over tau of |u|, of |w| and of |c|

  bool is_circle() const { return kind == Kind::circle; }
  CurveAt at(double tau) const {
    return {is_circle(), evaluate_series(series[0].data(), terms, tau), evaluate_series(series[1].data(), terms, tau),
            evaluate_series(series[2].data(), terms, tau)};
  }
  CurveAt at_node(std::size_t n) const { return {is_circle(), values[0][n], values[1][n], values[2][n]}; }
  /// Computes all other members from `kind` and `values`.
  /// @param tolerance  accepted interpolation error, relative to the magnitude of the functions
  /// @return false if the error of the interpolation is larger
  bool interpolate(double tolerance);
};

/// Values of a function of tau at the Chebyshev nodes, with a bound of the rounding errors of these values.
struct Sampled {
  Samples values;
  double rounding = 0;
};

/// Samples a function of tau that is 0 where two curves touch. For a circle with centre m and squared radius s, and
/// another curve, with the line b . p + c = 0 through their crossings, it is |b|^2 s - (b . m + c)^2, which is positive
/// where they cross. For two lines it is the determinant of their normals, which has either sign where they cross.
void discriminant(const BoundaryCurve& i, const BoundaryCurve& j, Sampled& result);

/// Samples a function of tau that is 0 where three curves meet in one point. If one of them is a circle, it is the
/// power of their radical centre times the square of a determinant; for three lines it is a determinant.
void concurrence(const BoundaryCurve& i, const BoundaryCurve& j, const BoundaryCurve& k, Sampled& result);

/// Whether two curves, at least one of which is a circle, cross each other.
bool has_crossing(const CurveAt& i, const CurveAt& j);

/// One of the two points in which two curves cross. Two lines cross in a single point, which is returned for both
/// values of `branch`.
/// @param branch  1 or -1: which of the two points
Vector crossing(const CurveAt& i, const CurveAt& j, double branch);

}  // namespace pkm::generic::corner_curves
