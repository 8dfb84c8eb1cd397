// Feasibility of a single pose of 4PPa-2PaR, margin by margin, the cheap ones first: voxels and columns are compared
// with it, in value and in speed. Angles are compared by the sides of triangles.
#pragma once

#include <cmath>

#include "tests/unit/accelerators/four_ppa_two_par/limbs_at.hpp"

namespace pkm::testing {

/// The closest pair of links, by all pairs.
template <class S>
ClosestPair<S> nearest_links(const four_ppa_two_par::Links<S>& all) {
  return closest_pair(all, [](const auto& visit) {
    for (const auto& pair : four_ppa_two_par::kPairs) visit_links(pair, visit);
  });
}

/// Whether a pose is feasible in the mode lower,lower. @param y  not mirrored
inline bool feasible(const Geometry<double>& g, const four_ppa_two_par::Limits<double>& l, double x, double y, double z,
                     double sin_theta, double cos_theta) {
  if (!(cos_theta >= l.cos_theta_min)) return false;
  const double half = g.a * cos_theta * 0.5;
  for (const double x_j : {x - half, g.b - x - half})  // most poses fail here, before a root is taken
    if (!(x_j >= 0 && x_j <= g.l_d && x_j >= g.l_d * l.sin_beta_min && x_j <= g.l_d * l.sin_beta_max)) return false;
  Limbs<double> limb;
  for (std::size_t j = 0; j < 2; ++j) {
    place_limb(g, x, y, z, {sin_theta, cos_theta}, Branch::lower, j, limb);
    const double drop = -limb.z_c[j];
    if (!(drop <= g.l_u && drop >= 0 && drop >= g.l_u * l.sin_alpha_min && limb.h[j] >= l.h_min &&
          limb.y[j] - limb.h[j] >= 0 && limb.y[j] + limb.h[j] <= g.L0))
      return false;
  }
  if (!(std::fabs(limb.x[0] * limb.sigma[1] + limb.x[1] * limb.sigma[0]) >= l.sin_par_min * g.l_d * g.l_d))
    return false;
  return !l.clearance_min ||
         nearest_links(links(g, lower_placement(g, x, z, sin_theta, cos_theta))).clearance >= *l.clearance_min;
}

}  // namespace pkm::testing
