// A quadric f(p) >= 0 as a body, and derivatives by its coefficients from those by the members of the body.
#pragma once

#include <span>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// Coefficients of 1, x, y, z, x^2, y^2, z^2, x y, x z, y z of a quadric.
using QuadricCoefficients = std::span<const double, 10>;

/// Satisfied, violated: f >= 0, or f < 0, at all points; body: see classify(); other: none of these.
enum class QuadricKind { satisfied, violated, body, other };

/// Classifies the constraint f >= 0, and sets `body` if it is a plane, sphere or cylinder.
/// @param bound  distance from the origin [m]; a coefficient that contributes only rounding errors up to this distance
///               is 0
QuadricKind classify(QuadricCoefficients f, double bound, Body& body);

/// Converts the derivatives of a quantity from members of the body to coefficients, for changes that do not change the
/// kind.
/// @param by  derivatives of the quantity with respect to the members of the body that classify() has set
std::array<double, 10> by_coefficients(QuadricCoefficients f, const Body& body, const Body& by);

}  // namespace pkm::generic::edges
