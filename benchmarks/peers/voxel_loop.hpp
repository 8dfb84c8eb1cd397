// Hand-written voxel count of the workspace of 4PPa-2PaR, as a designer would write it: three loops and the inverse
// kinematics (eq 13 of the mechanism's paper) at each voxel's centre. Expressions that do not depend on z are hoisted
// out of the inner loop.
#pragma once

#include <array>
#include <cstdint>

namespace pkm::peers {

/// Data shared by all designs: lengths [m], angles [rad]. Names and meaning of the limits are those of `pkmopt list
/// mechanisms 4ppa-2par`.
struct Voxels {
  double d, L0;
  std::array<int, 3> cells;  ///< along x, z, theta
  double alpha_min, beta_min, beta_max, h_min, sin_par_min, cos_theta_min;
};

/// a, b, l_u, l_d [m].
using Design = std::array<double, 4>;

/// Counts the feasible voxels in the lower working mode on the plane y = L0/2. The box is x in [0, b], z in [-(l_u +
/// l_d + d), -d], theta in [-pi/2, pi/2].
std::int64_t feasible_cells(const Voxels& voxels, const Design& design);

}  // namespace pkm::peers
