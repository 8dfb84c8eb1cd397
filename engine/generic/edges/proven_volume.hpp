// Proven bounds of the volume of a solid bounded by planes, spheres, cylinders and tori (README.md, "Proven bounds").
#pragma once

#include <optional>
#include <vector>

#include "engine/generic/edges/solid.hpp"
#include "engine/math/interval.hpp"

namespace pkm::generic::edges {

using IntervalVector = Vector<Interval, 3>;

/// A body whose numbers lie in intervals.
struct IntervalBody {
  Body::Kind kind = Body::Kind::plane;
  IntervalVector centre{}, axis{}, zero{};
  Interval radius{}, crank{}, from{}, to{};
  double side = 1;
  bool is_first_root = true;
};
/// The body with the given numbers, where directions have exactly unit length and `zero` is exactly normal to `axis`.
IntervalBody enclosed(const Body& body);

/// Bounds of the volume of the intersection of bodies, for all numbers in the intervals; rounding errors are included.
/// @param bound  upper bound of the distance of the points of the solid from the origin [m]
/// @return std::nullopt if no bounds can be proven, because surfaces touch or coincide, or too many intervals are
/// needed
std::optional<Interval> proven_volume(const std::vector<IntervalBody>& bodies, double bound);

}  // namespace pkm::generic::edges
