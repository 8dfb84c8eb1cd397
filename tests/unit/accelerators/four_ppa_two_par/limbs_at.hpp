// Positions of the limbs of 4PPa-2PaR in every working mode, by the formulas of the accelerator's README.md.
#pragma once

#include <cmath>
#include <optional>

#include "engine/accelerators/four_ppa_two_par/links.hpp"

namespace pkm::testing {

using four_ppa_two_par::Geometry, four_ppa_two_par::Placement;

/// Branch of a limb: lower if the platform hangs below C_j.
enum class Branch { lower, upper };
using WorkingMode = std::array<Branch, 2>;
inline constexpr WorkingMode kLowerMode = {Branch::lower, Branch::lower};

/// Position of the limbs at a pose. Exists where x_j is in [0, l_d] and |z_cj| <= l_u.
template <class S>
struct Limbs {
  std::array<S, 2> x, y, sigma, z_c, h;  ///< [m]
};

/// Position of limb j at a pose; where it does not reach, roots are 0.
template <class S>
void place_limb(const Geometry<S>& g, const S& x, const S& y, const S& z, const SinCosOf<S>& theta, Branch branch,
                std::size_t j, Limbs<S>& limb) {
  const S shift = g.a * theta.sin * 0.5, half = g.a * theta.cos * 0.5;
  limb.x[j] = j == 0 ? S(x - half) : S(g.b - x - half);
  limb.y[j] = j == 0 ? S(y - shift) : S(y + shift);
  limb.sigma[j] = sqrt_or_zero(S((g.l_d - limb.x[j]) * (g.l_d + limb.x[j])));
  limb.z_c[j] = branch == Branch::lower ? S(z + g.d + limb.sigma[j]) : S(z + g.d - limb.sigma[j]);
  limb.h[j] = sqrt_or_zero(S((g.l_u - limb.z_c[j]) * (g.l_u + limb.z_c[j])));
}

template <class S>
Placement<S> placement(const Limbs<S>& limb, const S& sin_theta, WorkingMode mode) {
  Placement<S> p = {.sin_theta = sin_theta, .x = limb.x, .drop = limb.sigma, .z_c = limb.z_c, .h = limb.h};
  for (std::size_t j = 0; j < 2; ++j)
    if (mode[j] == Branch::upper) p.drop[j] = -limb.sigma[j];
  return p;
}

/// None where the pose is out of reach, or the platform is not between the rails.
inline std::optional<Limbs<double>> limbs_at(const Geometry<double>& g, const SchoenfliesPose<double>& pose,
                                             WorkingMode mode) {
  Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) {
    place_limb(g, pose.x, pose.y, pose.z, sincos(pose.angle), mode[j], j, limbs);
    if (!(limbs.x[j] >= 0 && limbs.x[j] <= g.l_d && std::fabs(limbs.z_c[j]) <= g.l_u)) return {};
  }
  return limbs;
}

/// @param number  position in kModes
inline WorkingMode working_mode(int number) {
  return {number & 2 ? Branch::upper : Branch::lower, number & 1 ? Branch::upper : Branch::lower};
}

}  // namespace pkm::testing
