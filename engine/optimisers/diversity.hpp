// Which designs of a front tell most of it: what is kept when there are too many.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/optimisers/dominance.hpp"

namespace pkm {

/// The designs of a front in the order in which they are worth keeping, `keep` of them and then the others.
///
/// The others were removed one by one, each the most crowded of those that were left, so that its neighbours had more
/// room from then on (Kukkonen & Deb 2006); the last one removed comes first. Those kept come by the room that they
/// have left, the best of each score in front.
///
/// Crowded means little room: for 2 scores the area that the front would lose without the design, which no scaling of
/// the scores changes; for more the product of the distances to as many nearest neighbours as there are scores, each
/// score in units of its range. About O(n log n) for 2 scores and O(n^1.5) for 3.
std::vector<std::uint32_t> most_diverse(const Scores& scores, std::size_t keep);

/// How unevenly the designs of a front lie: mean absolute deviation of the distances to the nearest neighbour over
/// their mean, each score in units of its range. 0: all alike. NaN for fewer than three designs.
double spread(const Scores& scores);

}  // namespace pkm
