#include "engine/mechanisms/four_ppa_two_par/dynamics.hpp"

#include <algorithm>

namespace pkm::four_ppa_two_par {

std::optional<Influence<double>> influence(const Geometry<double>& g, const Pose<double>& pose, WorkingMode mode) {
  const Limbs<double> limbs = inverse(g, pose, mode);
  if (!limbs.assembles || std::ranges::count(limbs.sigma, 0) || std::ranges::count(limbs.h, 0)) return std::nullopt;
  const SinCosOf<double> theta = sincos(pose.angle);
  const auto sliders = [&](const Vector<double, 4>& velocity) {
    std::array<Follower<double>, 4> q;
    for (std::size_t j = 0; j < 2; ++j) {
      const auto m = limb_motion(g, {pose, velocity}, theta, limbs, j, signed_sigma(limbs, mode, j));
      for (std::size_t k = 0; k < 2; ++k) q[2 * j + k] = slider_motion(m, k);
    }
    return q;
  };
  Influence<double> found;
  const auto rows = sliders({});
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 4; ++c) found.G(i, c) = rows[i].row[c];
  found.H = matrices_of<4>([&](const Vector<double, 4>& velocity) {
    const auto q = sliders(velocity);
    return Vector<double, 4>{{q[0].bias, q[1].bias, q[2].bias, q[3].bias}};
  });
  return found;
}

}  // namespace pkm::four_ppa_two_par
