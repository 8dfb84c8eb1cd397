// Hand-written voxel count of the rotary Delta's workspace, as a designer would write it: three loops and the inverse
// kinematics at each voxel's centre. Expressions that do not depend on z are hoisted out of the inner loop.
#pragma once

#include <cstdint>

namespace pkm::peers {

/// Lengths [m] and angles [rad], named as in experiments/mechanisms/rotary-delta.toml.
struct Delta {
  double R, r, l_a, l_b, q_min, q_max;
};

/// Counts the voxels of an n^3 grid whose centres all three limbs reach within the crank ranges, elbows outwards. The
/// box is x, y in [-(l_a + l_b), l_a + l_b], z in [-(l_a + l_b), 0].
std::int64_t feasible_cells(const Delta& delta, int n);

}  // namespace pkm::peers
