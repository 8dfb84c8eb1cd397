// The workspace of 4PPa-2PaR on voxels as a designer would write it: three loops, and the inverse kinematics (eq 13 of
// the mechanism's paper) of each cell's centre. What does not depend on z stays out of the inner loop.
#pragma once

#include <array>
#include <cstdint>

namespace pkm::peers {

/// What designs share. Lengths [m], angles [rad]; the limits' names and meaning are the program's
/// (`pkmopt list mechanisms 4ppa-2par`).
struct Voxels {
  double d, L0;
  std::array<int, 3> cells;  ///< along x, z, theta
  double alpha_min, beta_min, beta_max, h_min, sin_par_min, cos_theta_min;
};

/// a, b, l_u, l_d [m].
using Design = std::array<double, 4>;

/// Number of feasible cells in the lower mode on the plane y = L0/2; the box is x in [0, b], z in
/// [-(l_u + l_d + d), -d], theta in [-pi/2, pi/2].
std::int64_t feasible_cells(const Voxels& voxels, const Design& design);

}  // namespace pkm::peers
