#include "engine/mechanisms/crr_cru/inspect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/mechanisms/crr_cru/margins.hpp"

namespace pkm::crr_cru {
namespace {

std::string numbered(const std::string& name, std::size_t limb) { return name + "_" + std::to_string(limb + 1); }

std::string out_of_reach(const Geometry<double>& g, const Limbs<double>& limbs) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (limbs.limb[i].reaches) continue;
    const auto& d = limbs.limb[i].d;
    const bool far = std::hypot(d[0], d[1]) > g.l_1[i] + g.l_2[i];
    const std::string rods = numbered("l", i) + "1", other = numbered("l", i) + "2";
    return "limb " + std::to_string(i + 1) + ": out of reach of its rods (|C - A| " +
           (far ? "> " + rods + " + " + other : "< |" + rods + " - " + other + "|") + ")";
  }
  return {};
}

}  // namespace

PoseReport inspect(const Geometry<double>& g, const LinkRadii<double>& radii, const Limits& l, const Pose<double>& pose,
                   const WorkingMode& mode) {
  PoseReport report;
  const Limbs<double> limbs = inverse(g, pose, mode);
  const auto [s, c] = sincos(pose.angle);
  const Yaw<double> y = yaw(g);
  const double kappa = parallel_index(y, s, c);
  report.assembles = limbs.assembles;
  report.indices = {{"det_J", kappa * y.R}, {"kappa_p", kappa}};
  std::array<double, kSine> least;  // of the two ends, where there are two
  least.fill(std::numeric_limits<double>::quiet_NaN());
  state_margins(design(g, {.c_min = l.c_min}), pose,  // s_min has a margin of its own here
                [&least](std::size_t which, double margin) { least[which] = std::fmin(least[which], margin); });
  for (std::size_t which = 0; which < least.size(); ++which)
    report.margins.emplace_back(kMarginNames[which], least[which]);
  if (!limbs.assembles) {
    report.reason = out_of_reach(g, limbs);
    return report;
  }
  report.T = schoenflies_twist(2);
  report.J = influence(limbs.arm).G;
  report.conditioning = conditioning(limbs.arm, characteristic_length(g));
  report.joints.emplace(std::size_t{4});
  double least_sine = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const Limb<double>& limb = limbs.limb[i];
    (*report.joints)[i] = limb.rho;
    report.angles.emplace_back(numbered("theta", i) + "1", atan2(limb.u1[1], limb.u1[0]));
    report.angles.emplace_back(numbered("theta", i) + "2", atan2(limb.sin_2, limb.cos_2));
    report.indices.emplace_back(numbered("sin_theta", i) + "2", limb.sin_2);
    least_sine = std::fmin(least_sine, std::fabs(limb.sin_2));
  }
  report.margins.emplace_back(kMarginNames[kSine], least_sine - l.s_min);
  const Nearest<double> nearest = nearest_bodies(links(g, radii, limbs), l.obstacles);
  report.angles.emplace_back("clearance", nearest.clearance);
  if (l.clearance_min) report.margins.emplace_back(kMarginNames[kClear], nearest.clearance - *l.clearance_min);
  const auto broken = std::ranges::find_if(report.margins, [](const auto& margin) { return !(margin.second >= 0); });
  report.feasible = broken == report.margins.end();
  if (report.feasible) return report;
  report.reason = "limit " + broken->first + " is broken";
  if (broken->first == kMarginNames[kClear])
    report.reason +=
        ": " + link_name(nearest.first, g.platform) + " and " +
        (nearest.second < kLinks ? link_name(nearest.second, g.platform) : l.obstacles[nearest.second - kLinks].name) +
        (nearest.clearance < 0 ? " overlap" : " are too near");
  return report;
}

}  // namespace pkm::crr_cru
