// Circles, lines and other conics that bound the slices of a workspace as functions of the outer coordinate, their
// crossings, and the functions that vanish where two of them touch or three meet in one point.
//
// In the plane (x, y) of a slice a boundary curve is the zero set of
//
//   h(p) = a |p|^2 + b . p + c,   circle: a = 1, b = -2 m, c = |m|^2 - s;   line: a = 0, |b| = 1
//
// with centre m, squared radius s (which may be negative: no circle), unit normal b. Another conic is the zero set of a
// general quadratic polynomial h. The three functions of a circle or line and the six coefficients of another conic
// depend on one variable tau in [-1, 1] and are Chebyshev interpolants (chebyshev.hpp).
#pragma once

#include <cstdint>
#include <optional>

#include "engine/generic/corner_curves/chebyshev.hpp"

namespace pkm::generic::corner_curves {

struct Vector {
  double x, y;
};
inline double determinant(const Vector& g, const Vector& h) { return g.x * h.y - g.y * h.x; }

/// A curve at one value of tau. (u, w) is the centre of a circle or the unit normal of a line; c is the squared radius
/// of a circle, or the value of the curve's function h at the origin for a line. Conic: h = xx x^2 + xy x y + yy y^2 +
/// u x + w y + c.
struct CurveAt {
  bool is_circle;
  double u, w, c;
  bool is_conic = false;
  bool swaps = false;  ///< conics only; true: near feasible points the conic consists of graphs x(y); false: y(x)
  double xx = 0, xy = 0, yy = 0;

  double h(const Vector& p) const {
    if (is_circle) {
      const double x = p.x - u, y = p.y - w;
      return x * x + y * y - c;
    }
    const double linear = u * p.x + w * p.y + c;
    return is_conic ? linear + quadratic(p) : linear;
  }
  double quadratic(const Vector& p) const { return xx * p.x * p.x + (xy * p.x + yy * p.y) * p.y; }
  Vector gradient(const Vector& p) const {
    if (is_circle) return {2 * (p.x - u), 2 * (p.y - w)};
    if (!is_conic) return {u, w};
    return {u + 2 * xx * p.x + xy * p.y, w + xy * p.x + 2 * yy * p.y};
  }
};

/// A boundary curve of slices as a function of tau, the variable in [-1, 1] that stands for the outer coordinate.
struct BoundaryCurve {
  enum class Kind : std::uint8_t {
    circle,
    line,
    conic,
    cut  ///< line through the centre of a circle in the direction from which angles on the circle are counted
  };
  Kind kind = Kind::line;
  std::array<Samples, 3> values;  ///< u, w and c of CurveAt, at the Chebyshev nodes
  std::array<Samples, 3> series;  ///< Chebyshev coefficients of u, w and c
  /// Conics only: xx, xy and yy of CurveAt at the Chebyshev nodes, and their Chebyshev coefficients.
  struct Quadratic {
    std::array<Samples, 3> values, series;
  };
  std::optional<Quadratic> quadratic;
  /// Conics only. true: in the region in which points can be feasible, the conic consists of graphs x(y); false: of
  /// graphs y(x).
  bool swaps = false;
  /// Coefficients b_x, b_y and c of h(p) = a |p|^2 + b . p + c, at the Chebyshev nodes.
  std::array<Samples, 3> equation;
  std::size_t terms = kNodes;    ///< number of leading coefficients of `series` that are in use
  double tail = 0;               ///< interpolation error of `series`, estimated from the last coefficients
  double error = 0;              ///< `tail` plus a bound of the rounding errors
  double merged = 0;             ///< largest difference from the values of equal curves that this one stands for
  std::array<double, 3> size{};  ///< maximum over tau of |u|, of |w| and of |c|

  bool is_circle() const { return kind == Kind::circle; }
  bool is_conic() const { return kind == Kind::conic; }
  CurveAt at(double tau) const {
    const auto value = [&](const Samples& each) { return evaluate_series(each.data(), terms, tau); };
    CurveAt curve{is_circle(), value(series[0]), value(series[1]), value(series[2])};
    if (is_conic()) set_quadratic(curve, quadratic->series, value);
    return curve;
  }
  CurveAt at_node(std::size_t n) const {
    CurveAt curve{is_circle(), values[0][n], values[1][n], values[2][n]};
    if (is_conic()) set_quadratic(curve, quadratic->values, [n](const Samples& each) { return each[n]; });
    return curve;
  }
  /// Computes all other members from `kind` and `values`.
  /// @param tolerance  accepted interpolation error, relative to the magnitude of the functions
  /// @return false if the error of the interpolation is larger
  bool interpolate(double tolerance);
  /// Chooses `swaps` for a conic.
  /// @param half_widths  of the rectangle |x| <= half_widths[0], |y| <= half_widths[1] that contains all feasible
  /// points
  /// @return false if the conic may have tangents of both directions in the rectangle
  bool find_graphs(const std::array<double, 2>& half_widths);

  template <class Value>
  void set_quadratic(CurveAt& curve, const std::array<Samples, 3>& from, const Value& value) const {
    curve.is_conic = true;
    curve.swaps = swaps;
    curve.xx = value(from[0]);
    curve.xy = value(from[1]);
    curve.yy = value(from[2]);
  }
};

/// Values of a function of tau at the Chebyshev nodes, with a bound of the rounding errors of these values.
struct Sampled {
  Samples values;
  double rounding = 0;
};

/// Function that is positive where two circles, or a circle and a line, cross: the discriminant |b|^2 s - (b . m + c)^2
/// of a circle with centre m and squared radius s, and the common chord b . p + c = 0; for two lines the determinant of
/// their normals, of either sign.
void discriminant(const BoundaryCurve& i, const BoundaryCurve& j, Sampled& result);

/// Function that vanishes where three circles or lines meet in one point: the power of their radical centre, times the
/// square of a determinant; for three lines a determinant.
void concurrence(const BoundaryCurve& i, const BoundaryCurve& j, const BoundaryCurve& k, Sampled& result);

/// Whether a circle and another circle or a line cross each other.
bool has_crossing(const CurveAt& i, const CurveAt& j);

/// One of the two points in which two circles or lines cross; for two lines there is one, whatever the branch.
/// @param branch  1 or -1: which of the two points
Vector crossing(const CurveAt& i, const CurveAt& j, double branch);

}  // namespace pkm::generic::corner_curves
