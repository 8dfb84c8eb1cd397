// The moves of a motion between its stops.
#pragma once

#include <vector>

#include "engine/motion/motion.hpp"

namespace pkm {

/// The time from the start to the end of a move between two stops [s].
struct MovePeriod {
  double begin = 0, end = 0;
};

/// The moves of a motion, in order; between them the platform is at rest. Stops are found by sampling the speed at 10^4
/// times, so that shorter moves or pauses can be missed: the ends of pauses, in which the speed is exactly 0, are
/// located by bisection, and other minima of the speed by golden-section search; there the platform stops if its speed
/// is less than a millionth of the maximum.
std::vector<MovePeriod> find_moves(const Motion& motion);

}  // namespace pkm
