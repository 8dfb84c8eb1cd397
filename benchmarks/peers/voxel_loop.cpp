#include "benchmarks/peers/voxel_loop.hpp"

#include <cmath>
#include <numbers>

namespace pkm::peers {

std::int64_t feasible_cells(const Voxels& voxels, const Design& design) {
  constexpr double kPi = std::numbers::pi;
  const auto [a, b, l_u, l_d] = design;
  const auto [n_x, n_z, n_theta] = voxels.cells;
  const double y = voxels.L0 / 2;
  const double x_min = l_d * std::sin(voxels.beta_min), x_max = l_d * std::sin(voxels.beta_max);  // eqs 17, 20
  const double z_max = -l_u * std::sin(voxels.alpha_min);                                         // eq 17
  std::int64_t feasible = 0;
  for (int k = 0; k < n_theta; ++k) {
    const double theta = -kPi / 2 + (k + 0.5) * kPi / n_theta, c = std::cos(theta);
    if (c < voxels.cos_theta_min) continue;
    const double half = a / 2 * c, shift = a / 2 * std::sin(theta);
    for (int i = 0; i < n_x; ++i) {
      const double x = (i + 0.5) * b / n_x, x_1 = x - half, x_2 = b - x - half;
      if (x_1 < x_min || x_1 > x_max || x_2 < x_min || x_2 > x_max) continue;
      const double sigma_1 = std::sqrt(l_d * l_d - x_1 * x_1), sigma_2 = std::sqrt(l_d * l_d - x_2 * x_2);
      if (x_1 * sigma_2 + sigma_1 * x_2 < voxels.sin_par_min * l_d * l_d) continue;  // eq 15
      for (int j = 0; j < n_z; ++j) {
        const double z = -(l_u + l_d + voxels.d) + (j + 0.5) * (l_u + l_d) / n_z;
        const double z_1 = z + voxels.d + sigma_1, z_2 = z + voxels.d + sigma_2;
        if (z_1 > z_max || z_1 < -l_u || z_2 > z_max || z_2 < -l_u) continue;
        const double h_1 = std::sqrt(l_u * l_u - z_1 * z_1), h_2 = std::sqrt(l_u * l_u - z_2 * z_2);
        if (h_1 < voxels.h_min || h_2 < voxels.h_min) continue;  // eq 19
        const double q_1 = y - shift - h_1, q_2 = y - shift + h_1, q_3 = y + shift - h_2, q_4 = y + shift + h_2;
        if (q_1 >= 0 && q_2 <= voxels.L0 && q_3 >= 0 && q_4 <= voxels.L0) ++feasible;
      }
    }
  }
  return feasible;
}

}  // namespace pkm::peers
