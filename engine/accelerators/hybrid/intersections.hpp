// Hybrid robot: intersections of two edges of a slice.
#pragma once

#include <limits>

#include "engine/accelerators/hybrid/strips.hpp"

namespace pkm::hybrid {

inline constexpr double kNoIntersection = std::numeric_limits<double>::quiet_NaN();

/// Whether two edges are bounds due to the auxiliary chain on one side: they intersect where Q, P, lw_max cos(phi_max)
/// or lw_min cos(phi_max), which are linear in z, are equal.
inline bool of_chain(const Edge& first, const Edge& second) {
  return first.curve >= kCurveQ && second.curve >= kCurveQ && first.side == second.side;
}

/// z at which two edges intersect whose order differs at p and q: in closed form, or by Newton's method safeguarded by
/// bisection. Edges of the chain intersect at bit-identical heights on both sides.
double intersection(const Slice<double>& s, const Edge& first, const Edge& second, double p, double q);

/// z of an intersection near a given z; kNoIntersection if Newton's method does not converge there.
double intersection_near(const Slice<double>& s, const Edge& first, const Edge& second, double z);

}  // namespace pkm::hybrid
