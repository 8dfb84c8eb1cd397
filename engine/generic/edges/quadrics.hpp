// A quadric f(p) >= 0 as a body, and derivatives by its coefficients from those by the members of the body.
#pragma once

#include <span>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// Coefficients of 1, x, y, z, x^2, y^2, z^2, x y, x z, y z of a quadric.
using QuadricCoefficients = std::span<const double, 10>;

/// Classification of a constraint f(p) >= 0. satisfied: f >= 0 at all points; violated: f < 0 at all points; body: the
/// points with f >= 0 are a half-space, or the inside or outside of a sphere or cylinder; other: none of these.
enum class QuadricKind { satisfied, violated, body, other };

/// Classifies the constraint f >= 0. If it is a plane, sphere or cylinder, sets `body`.
/// @param bound  distance of relevant points from the origin [m]; a coefficient that contributes only rounding errors
///               up to this distance counts as 0
QuadricKind classify(QuadricCoefficients f, double bound, Body& body);

/// Converts the derivatives of a quantity with respect to the members of the body that classify() has set to
/// derivatives with respect to the coefficients of the quadric. Valid for changes after which f still is a plane,
/// sphere or cylinder.
/// @param by  derivatives of the quantity with respect to the members of the body
std::array<double, 10> by_coefficients(QuadricCoefficients f, const Body& body, const Body& by);

}  // namespace pkm::generic::edges
