// How much of the objectives' space a set of points dominates: the usual measure of a trade-off, which grows with every
// point that no other dominates.
#pragma once

#include <cstddef>
#include <span>

namespace pkm {

/// Measure of what at least one point dominates, up to the reference point: the union of the boxes [point, reference],
/// exactly (but for rounding, a few bits), in the product of the objectives' units.
///
/// Points that are not finite, or not better than the reference in every objective, count nothing. Neither the points'
/// order nor dominated or repeated ones change a bit of the result.
/// @param points      row by row, `objectives` values each, all to be minimised
/// @param objectives  2 or 3; others throw std::invalid_argument, and so does a reference that is not finite
/// @param reference   `objectives` values
double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference);

}  // namespace pkm
