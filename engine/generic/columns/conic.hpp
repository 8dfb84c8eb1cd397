// Conics P(t, s) = 0 in the square [-1, 1]^2: where they have their extremes and cross, and integrals along their arcs.
#pragma once

#include <span>

#include "engine/generic/columns/polynomial.hpp"

namespace pkm::generic {

/// Coefficients of 1, t, s, t^2, t s, s^2.
struct Conic {
  std::array<double, 6> c{};
  double scale = 0;  ///< sum of their magnitudes: what P can be in the square

  double at(double t, double s) const { return c[0] + t * (c[1] + t * c[3]) + s * (c[2] + t * c[4] + s * c[5]); }
  /// By the powers of s.
  std::array<double, 3> along(double t) const { return {c[0] + t * (c[1] + t * c[3]), c[2] + t * c[4], c[5]}; }
  /// Of the quadratic in s, as a polynomial in t.
  std::array<double, 3> discriminant() const {
    return {c[2] * c[2] - 4 * c[5] * c[0], 2 * c[2] * c[4] - 4 * c[5] * c[1], c[4] * c[4] - 4 * c[5] * c[3]};
  }
  bool is_straight() const { return c[5] == 0; }  ///< along s: one root at most
};

struct Point {
  double t, s;
};
/// Where two conics cross in the square, or nearly touch; the number of them.
std::size_t crossings(const Conic& P, const Conic& Q, std::array<Point, 16>& points);

/// A part of a conic on which s is a function of t: root number `root` at t in [from, to].
struct Arc {
  int root;
  double from, to;
};

/// The root of an arc at a place in it.
double place_on(const Conic& P, int root, double t);

/// Integral of s dt.
double area_below(const Conic& P, const Arc& arc);

/// Adds to `slopes` the derivatives of factor * area_below() by the coefficients.
void add_slopes_of_area(const Conic& P, const Arc& arc, double factor, std::array<double, 6>& slopes);

}  // namespace pkm::generic
