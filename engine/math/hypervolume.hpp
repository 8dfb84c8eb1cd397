// Hypervolume indicator of a set of points (Zitzler and Thiele 1999): the measure of the part of the objective space
// that the set dominates. It increases with every additional non-dominated point.
#pragma once

#include <cstddef>
#include <span>

namespace pkm {

/// Area or volume of the union of the boxes [point, reference], exact to rounding errors, in the product of the units
/// of the objectives.
///
/// Points that are not finite, or not better than the reference point in every objective, are ignored. The result is
/// bit-identical for any order of the points, and with or without dominated and duplicate points.
/// @param points      row-major, `objectives` values per point, all to be minimised
/// @param objectives  2 or 3; otherwise throws std::invalid_argument
/// @param reference   reference point, `objectives` values; throws std::invalid_argument if it is not finite
double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference);

}  // namespace pkm
