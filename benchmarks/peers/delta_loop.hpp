// The workspace of the rotary Delta on voxels as a designer would write it: three loops, and the inverse kinematics of
// each cell's centre. What does not depend on z stays out of the inner loop.
#pragma once

#include <cstdint>

namespace pkm::peers {

/// Lengths [m] and angles [rad], as experiments/mechanisms/rotary-delta.toml calls them.
struct Delta {
  double R, r, l_a, l_b, q_min, q_max;
};

/// Number of cells of n^3 whose centres all three cranks reach within their range, elbows outwards; the box is
/// x, y in [-(l_a + l_b), l_a + l_b], z in [-(l_a + l_b), 0].
std::int64_t feasible_cells(const Delta& delta, int n);

}  // namespace pkm::peers
