// (3CRR/R)&CRU and Quadrupteron: what limits a pose. This is the one statement of it; the tests hold the closed forms
// against it that take its place where poses come in numbers: frame.hpp and section.hpp, with squares instead of
// roots, rings_kernel.cpp, with the ends of chords, and keep_clear, which stops at the first pair of links.
#pragma once

#include <span>
#include <vector>

#include "engine/mechanisms/crr_cru/frame.hpp"
#include "engine/mechanisms/crr_cru/links.hpp"

namespace pkm::crr_cru {

/// What has a margin, in the order of reports. |sin theta_i2| >= s_min either has its own or narrows the reach.
enum Margin : std::size_t { kReach, kStroke = 4, kParallel = 8, kSine, kClear, kMargins };
inline constexpr std::array<const char*, kMargins> kMarginNames = {"reach_1",  "reach_2",  "reach_3",      "reach_4",
                                                                   "stroke_1", "stroke_2", "stroke_3",     "stroke_4",
                                                                   "c_min",    "s_min",    "clearance_min"};

/// States the margins of a pose that exist wherever it is: say(which, margin) once for each end of |C_i - A_i| and of
/// rho_i [m], where the design's s_min narrows the reach, and for kappa_p.
template <class S, class Say>
void state_margins(const Design<S>& d, const Pose<double>& pose, const Say& say) {
  const std::array<double, 3> at = {pose.x, pose.y, pose.z};
  const auto [sin, cos] = sincos(S(pose.angle));
  const auto arm = arms(d.g, sin, cos);
  for (std::size_t i = 0; i < 4; ++i) {
    const LimbFrame& f = kLimbs[i];
    const S a = arm[i].to_joint[f.p] + at[f.p] - d.g.L * f.rail[f.p];
    const S b = arm[i].to_joint[f.q] + at[f.q] - d.g.L * f.rail[f.q];
    const S distance = root_or_zero(S(a * a + b * b)), rho = arm[i].to_joint[f.e] + at[f.e];
    say(kReach + i, S(distance - d.in[i]));
    say(kReach + i, S(d.out[i] - distance));
    say(kStroke + i, S(rho - d.g.rho_min));
    say(kStroke + i, S(d.g.rho_max - rho));
  }
  say(kParallel, S(parallel_index(d.yaw, sin, cos) - d.c_min));
}

/// Appends 17 margins [m] per pose; that of kappa_p is R (kappa_p - c_min), the distance from the parallel singularity
/// along the slides.
template <class S>
void add_margins(const Design<S>& d, std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) {
  const std::size_t before = margins.size();
  margins.resize(before + 17 * poses.size());
  S* to = margins.data() + before;
  for (const auto& pose : poses)
    state_margins(d, schoenflies(pose), [&](std::size_t which, const S& margin) {
      *to++ = which == kParallel ? S(d.yaw.R * margin) : margin;
    });
}

/// Appends the margin of the clearance limit [m], which there is, per pose. A pose that does not assemble has none: its
/// reach is broken.
template <class S>
void add_clearances(const Geometry<S>& g, const LinkRadii<S>& radii, const Limits& l, const WorkingMode& mode,
                    std::span<const pkm::Pose<double>> poses, std::vector<S>& margins) {
  for (const auto& pose : poses) {
    const Pose<double> at = schoenflies(pose);
    const Limbs<S> limbs = inverse(g, Pose<S>{S(at.x), S(at.y), S(at.z), S(at.angle)}, mode);
    if (limbs.assembles)
      margins.push_back(nearest_bodies(links(g, radii, limbs), l.obstacles).clearance - *l.clearance_min);
  }
}

}  // namespace pkm::crr_cru
