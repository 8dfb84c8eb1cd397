// (3CRR/R)&CRU and Quadrupteron: how far poses are from the ends of the feasible set, in lengths.
#pragma once

#include <span>
#include <vector>

#include "engine/mechanisms/crr_cru/frame.hpp"
#include "engine/mechanisms/crr_cru/links.hpp"

namespace pkm::crr_cru {

/// Appends 17 margins [m] per pose: of each limb the distances of |C - A| from both ends of its reach, s_min included,
/// and of its slide from both ends of the range; and R (kappa_p - c_min), the distance from the parallel singularity
/// along the slides.
template <class S>
void add_margins(const Design<S>& d, std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) {
  std::array<S, 4> inner, outer;
  for (std::size_t i = 0; i < 4; ++i) {
    inner[i] = root_or_zero(d.in2[i]);
    outer[i] = root_or_zero(d.out2[i]);
  }
  for (const auto& any : poses) {
    const Pose<double> pose = schoenflies(any);
    const std::array<double, 3> at = {pose.x, pose.y, pose.z};
    const auto [sin, cos] = sincos(S(pose.angle));
    const auto arm = arms(d.g, sin, cos);
    for (std::size_t i = 0; i < 4; ++i) {
      const LimbFrame& f = kLimbs[i];
      const S a = arm[i].to_joint[f.p] + at[f.p] - d.g.L * f.rail[f.p];
      const S b = arm[i].to_joint[f.q] + at[f.q] - d.g.L * f.rail[f.q];
      const S distance = root_or_zero(S(a * a + b * b)), rho = arm[i].to_joint[f.e] + at[f.e];
      margins.push_back(distance - inner[i]);
      margins.push_back(outer[i] - distance);
      margins.push_back(rho - d.g.rho_min);
      margins.push_back(d.g.rho_max - rho);
    }
    margins.push_back(d.yaw.R * (parallel_index(d.yaw, sin, cos) - d.c_min));
  }
}

/// Appends the margin of a clearance limit [m] per pose. A pose that does not assemble has none: its reach is broken.
template <class S>
void add_clearances(const Geometry<S>& g, const LinkRadii<S>& radii, double least, const WorkingMode& mode,
                    std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) {
  for (const auto& any : poses) {
    const Pose<double> at = schoenflies(any);
    const Limbs<S> limbs = inverse(g, Pose<S>{S(at.x), S(at.y), S(at.z), S(at.angle)}, mode);
    if (limbs.assembles) margins.push_back(nearest_links(links(g, radii, limbs)).clearance - least);
  }
}

}  // namespace pkm::crr_cru
