// Hybrid robot: intersections of two edges of a slice.
#pragma once

#include <limits>

#include "engine/accelerators/hybrid/strips.hpp"

namespace pkm::hybrid {

inline constexpr double kNoIntersection = std::numeric_limits<double>::quiet_NaN();

/// Returns true if two edges on the same side are bounds due to the auxiliary chain. Such edges intersect where two of
/// Q, P, lw_max cos(phi_max) and lw_min cos(phi_max), which are linear in z, are equal.
inline bool are_bounds_of_chain(const Edge& first, const Edge& second) {
  return first.curve >= kCurveQ && second.curve >= kCurveQ && first.side == second.side;
}

/// The z in [p, q] at which two edges intersect, if their order at p differs from that at q: in closed form, or by
/// Newton's method safeguarded by bisection. Edges due to the auxiliary chain intersect at bit-identical heights on
/// both sides.
double intersection(const Slice<double>& s, const Edge& first, const Edge& second, double p, double q);

/// The z, near a given z, at which two edges intersect; kNoIntersection if Newton's method does not converge there.
double intersection_near(const Slice<double>& s, const Edge& first, const Edge& second, double z);

}  // namespace pkm::hybrid
