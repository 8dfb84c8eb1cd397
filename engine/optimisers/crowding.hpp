// Crowding-distance ranking of a Pareto front (Kukkonen and Deb 2006), which selects the designs to keep if a front has
// too many, and the spacing indicator of a front.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/optimisers/dominance.hpp"

namespace pkm {

/// Orders the designs of a front by descending priority for survival: first the `keep` designs that survive truncation,
/// by descending crowding distance, then the truncated designs in the reverse order of their removal.
///
/// Truncation removes one design at a time, always the one with the smallest crowding distance, and updates the
/// crowding distances of its neighbours (Kukkonen and Deb 2006). With more than 2 scores, the best design of each score
/// has an infinite crowding distance.
///
/// The crowding distance is, for 2 scores, the exclusive hypervolume contribution (the area that only this design
/// dominates; infinite at both ends), so that the order does not depend on the scaling of the scores. For m > 2 scores
/// it is the product of the squared distances to the m nearest neighbours, each score divided by its range over the
/// front. Complexity: about O(n log n) for 2 scores and O(n^1.5) for 3.
///
/// @return the indices of all designs
std::vector<std::uint32_t> order_by_crowding(const Scores& scores, std::size_t keep);

/// Spacing indicator of a front: mean absolute deviation of the nearest-neighbour distances divided by their mean, each
/// score divided by its range. 0: evenly spaced. NaN for fewer than three designs.
double spread(const Scores& scores);

}  // namespace pkm
