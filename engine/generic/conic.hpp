// Conics P(t, s) = 0 in the square [-1, 1]^2: their intersections, and integrals along their arcs.
#pragma once

#include "engine/generic/polynomial.hpp"

namespace pkm::generic {

/// A conic P(t, s) = 0, by the coefficients of 1, t, s, t^2, t s, s^2 in P.
struct Conic {
  std::array<double, 6> c{};
  double scale = 0;  ///< sum of the magnitudes of the coefficients, an upper bound of |P| in the square

  double at(double t, double s) const { return c[0] + t * (c[1] + t * c[3]) + s * (c[2] + t * c[4] + s * c[5]); }
  /// Coefficients of P as a polynomial in s at a given t, constant term first.
  std::array<double, 3> along(double t) const { return {c[0] + t * (c[1] + t * c[3]), c[2] + t * c[4], c[5]}; }
  /// Discriminant of the quadratic P in s, as a polynomial in t, constant term first.
  std::array<double, 3> discriminant() const {
    return {c[2] * c[2] - 4 * c[5] * c[0], 2 * c[2] * c[4] - 4 * c[5] * c[1], c[4] * c[4] - 4 * c[5] * c[3]};
  }
  bool is_straight() const { return c[5] == 0; }  ///< true: P is linear in s, with at most one root
};

struct Point {
  double t, s;
};
/// Finds the intersections of two conics in the square, and points where they are nearly tangent. @return their number
std::size_t crossings(const Conic& P, const Conic& Q, std::array<Point, 16>& points);

/// An arc of a conic on which s is a function of t in [from, to]: the root with index `root` of the quadratic in s.
struct Arc {
  int root;
  double from, to;
};

/// The root s, with index `root` (0 or 1), of P(t, s) = 0 at a given t.
double place_on(const Conic& P, int root, double t);

/// Area between an arc and the line s = 0, with sign: the integral of s dt.
double area_below(const Conic& P, const Arc& arc);

/// Adds the derivatives of factor * area_below() with respect to the coefficients of the conic.
void add_gradient_of_area(const Conic& P, const Arc& arc, double factor, std::array<double, 6>& gradient);

}  // namespace pkm::generic
