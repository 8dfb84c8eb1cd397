// A quadric f(p) >= 0 as a body, and derivatives by its coefficients from those by the members of the body.
#pragma once

#include <span>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// Coefficients of 1, x, y, z, x^2, y^2, z^2, x y, x z, y z.
using QuadricCoefficients = std::span<const double, 10>;

enum class QuadricKind { satisfied, violated, body, other };  ///< satisfied, violated: at all points

/// @param bound  length; coefficients are zero if they contribute only rounding errors at this distance
QuadricKind classify(QuadricCoefficients f, double bound, Body& body);

/// The derivatives of a function by the coefficients, for changes that keep the kind.
/// @param by  derivatives by the members of the body that classify() returned
std::array<double, 10> by_coefficients(QuadricCoefficients f, const Body& body, const Body& by);

}  // namespace pkm::generic::edges
