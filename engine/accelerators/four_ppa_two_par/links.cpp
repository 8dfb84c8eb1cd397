#include "engine/accelerators/four_ppa_two_par/links.hpp"

namespace pkm::four_ppa_two_par {

Placement<double> lower_placement(const Geometry<double>& g, double x, double z, double sin_theta, double cos_theta) {
  Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) place_limb(g, x, 0.0, z, {sin_theta, cos_theta}, kLowerMode[j], j, limbs);
  return placement(limbs, sin_theta, kLowerMode);
}

}  // namespace pkm::four_ppa_two_par
