// How far a known front is from the points found.
#pragma once

#include <cstddef>
#include <span>

namespace pkm {

/// Modified inverted generational distance (Ishibuchi, Masuda, Tanigaki and Nojima 2015, IGD+): the mean, over the
/// points z of the front, of the least of
///   | max(a - z, 0) / extents |      (Euclidean norm, coordinate by coordinate inside)
/// over the points a. A point that dominates z has distance 0 to it. Infinite without points; points with a NaN count
/// nothing. The points' order changes no bit.
/// @param points      row by row, `objectives` values each, all to be minimised
/// @param front       likewise; an empty one throws std::invalid_argument
/// @param extents     `objectives` lengths > 0, one for each objective, that make distances comparable
double igd_plus(std::span<const double> points, std::size_t objectives, std::span<const double> front,
                std::span<const double> extents);

}  // namespace pkm
