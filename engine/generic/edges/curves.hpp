// Intersection curves of two surfaces, as functions of a parameter t.
//
//   circles, ellipses      p(t) = o + x cos t + y sin t
//   lines                  p(t) = o + x t
//   cylinder and quadric   p(t) = o + x cos t + y sin t +- sqrt(D(t)) w: the generator at the angle t in two points
//   torus and steep plane  the same: the parallel circle at the height rod sin t in two points
//   torus and sphere or    the meridian circle at the angle t in two points, cos b = (alpha gamma -+ beta sqrt(D)) / Q,
//     flat plane           sin b = (beta gamma +- alpha sqrt(D)) / Q (see on_torus() in the source)
//   torus and cylinder,    in boxes, one coordinate of the torus is an implicit function of the other one
//     general tori           (torus_function.hpp)
//
// D is a trigonometric polynomial of degree two. Its roots are turning points, where the two branches meet. A curve is
// divided into arcs, each from a turning point t_0 or without one. With t = t_0 +- u^2 at a simple root, and
// t = t_0 +- u at a double one, sqrt(D) is the power of u times an analytic function, so that an arc is analytic up to
// its ends.
#pragma once

#include <optional>

#include "engine/generic/edges/torus_function.hpp"

namespace pkm::generic::edges {

/// Coefficients of the function square |p|^2 - across (p . axis)^2 + v . p + k of a point p, which is 0 on a plane,
/// sphere or cylinder.
struct Quadric {
  double square = 0, across = 0;
  Vector3 axis{}, v{};
  double k = 0;
};

/// An intersection curve of two faces' surfaces. The members o, x, y, w and D are those of the table at the top of this
/// file.
struct Curve {
  enum class Kind : std::uint8_t { trigonometric, line, on_torus, implicit };
  Kind kind = Kind::trigonometric;
  std::array<const Face*, 2> faces{};
  /// Vectors in the formula of the points p(t); w is 0 for a curve without a square root.
  Vector3 o{}, x{}, y{}, w{};
  bool has_root = false;  ///< true: the curve has two branches, with +sqrt(D) and -sqrt(D)
  Trigonometric D{};
  std::optional<Affine> square{};  ///< |p|^2 as an affine function of p, if one of the surfaces is a sphere
  Quadric with{};  ///< on_torus only: function of the second surface, for the vector from the centre of the torus
  std::optional<Quadric> cut{};  ///< function that vanishes where the two surfaces touch each other, if there is one
  TorusFunction function{};      ///< implicit curves only: the zeros of this function on a torus form the curve
};

/// An interval u in [0, length] of one branch of a curve.
struct Arc {
  const Curve* curve;
  double branch = 1;
  double t_0 = 0, direction = 1;
  int order = 0;  ///< multiplicity of the root that D has at u = 0; 0 if it has no root there
  double length = 0;
  TorusArc implicit{};
};

/// Adds the intersection curves of the surfaces of two faces.
/// @param bound  straight lines extend by this length in both directions [m]
/// @return false if the surfaces are the same
bool add_intersection(const Face& a, const Face& b, double bound, std::vector<Curve>& curves);
/// The circle that separates an end face (half sphere) of a slide or crank from its fold (cylinder or torus).
Curve equator(const Face& end, const Face& fold);

/// A root t of the trigonometric polynomial Curve::D, and its multiplicity (`order`).
struct CurveRoot {
  double t;
  int order;
};

/// Divides a curve, of any kind but `implicit`, into arcs and appends them to `arcs`.
/// @param bound  straight lines extend by this length in both directions [m]
/// @param roots  scratch memory
/// @return false if D is 0 everywhere
bool add_arcs(const Curve& curve, double bound, std::vector<CurveRoot>& roots, std::vector<Arc>& arcs);

/// The point of a torus at the angles q of the crank and b around the fold.
CurvePoint point_on(const Face& torus, const Enclosure& q, const Enclosure& b);

/// Enclosure of the points of an arc for an interval of its parameter u.
/// @param u  made by Enclosure::variable(), so that the slope of the result is dp/du
CurvePoint point(const Arc& arc, const Enclosure& u);
Enclosure evaluate(const Quadric& quadric, const CurvePoint& at);

}  // namespace pkm::generic::edges
