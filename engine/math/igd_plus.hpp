// Modified inverted generational distance (IGD+) of a set of points from a known Pareto front.
#pragma once

#include <cstddef>
#include <span>

namespace pkm {

/// IGD+ (Ishibuchi, Masuda, Tanigaki and Nojima 2015): the mean, over the points z of the front, of the minimum over
/// the points a of
///   || max(a - z, 0) / extents ||      (Euclidean norm; maximum and quotient component by component)
/// A point that dominates z has distance 0 to it. Infinite if there are no points; points with a NaN are ignored. The
/// result is bit-identical for any order of the points.
/// @param points      row-major, `objectives` values per point, all to be minimised
/// @param front       points of the known front, in the same layout; throws std::invalid_argument if it is empty
/// @param extents     `objectives` lengths > 0 that scale the objectives to comparable sizes
double igd_plus(std::span<const double> points, std::size_t objectives, std::span<const double> front,
                std::span<const double> extents);

}  // namespace pkm
