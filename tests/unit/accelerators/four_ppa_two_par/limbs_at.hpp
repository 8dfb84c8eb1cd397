// Positions of 4PPa-2PaR's limbs, by the accelerator's formulas.
#pragma once

#include <cmath>
#include <optional>

#include "engine/accelerators/four_ppa_two_par/model.hpp"

namespace pkm::testing {

/// None where the pose is out of reach, or the platform is not between the rails.
inline std::optional<four_ppa_two_par::Limbs<double>> limbs_at(const four_ppa_two_par::Geometry<double>& g,
                                                               const SchoenfliesPose<double>& pose,
                                                               four_ppa_two_par::WorkingMode mode) {
  four_ppa_two_par::Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) {
    four_ppa_two_par::place_limb(g, pose.x, pose.y, pose.z, sincos(pose.angle), mode[j], j, limbs);
    if (!(limbs.x[j] >= 0 && limbs.x[j] <= g.l_d && std::fabs(limbs.z_c[j]) <= g.l_u)) return {};
  }
  return limbs;
}

/// @param number  position in kModes
inline four_ppa_two_par::WorkingMode working_mode(int number) {
  using four_ppa_two_par::Branch;
  return {number & 2 ? Branch::upper : Branch::lower, number & 1 ? Branch::upper : Branch::lower};
}

}  // namespace pkm::testing
