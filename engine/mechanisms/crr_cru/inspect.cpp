#include "engine/mechanisms/crr_cru/inspect.hpp"

#include <cmath>

#include "engine/mechanisms/crr_cru/yaw.hpp"

namespace pkm::crr_cru {
namespace {

std::string numbered(const std::string& name, std::size_t limb) { return name + "_" + std::to_string(limb + 1); }

std::string out_of_reach(const Geometry<double>& g, const Limbs<double>& limbs) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (limbs.limb[i].reach >= 0) continue;
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
  for (std::size_t i = 0; i < 4; ++i) report.margins.emplace_back(numbered("reach", i), limbs.limb[i].reach);
  for (std::size_t i = 0; i < 4; ++i) {
    const double rho = limbs.limb[i].rho;
    report.margins.emplace_back(numbered("stroke", i), std::fmin(rho - g.rho_min, g.rho_max - rho));
  }
  report.margins.emplace_back("c_min", kappa - l.c_min);
  if (!limbs.assembles) {
    report.reason = out_of_reach(g, limbs);
    return report;
  }
  report.J = jacobian(limbs.arm);
  report.conditioning = conditioning(limbs.arm, characteristic_length(g));
  report.joints.emplace();
  double least_sine = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const Limb<double>& limb = limbs.limb[i];
    (*report.joints)[i] = limb.rho;
    report.angles.emplace_back(numbered("theta", i) + "1", atan2(limb.u1[1], limb.u1[0]));
    report.angles.emplace_back(numbered("theta", i) + "2", atan2(limb.sin_2, limb.cos_2));
    report.indices.emplace_back(numbered("sin_theta", i) + "2", limb.sin_2);
    least_sine = std::fmin(least_sine, std::fabs(limb.sin_2));
  }
  report.margins.emplace_back("s_min", least_sine - l.s_min);
  const Nearest<double> nearest = nearest_links(links(g, radii, limbs));
  report.angles.emplace_back("clearance", nearest.clearance);
  if (l.clearance_min) report.margins.emplace_back("clearance_min", nearest.clearance - *l.clearance_min);
  report.feasible = true;
  for (const auto& [name, margin] : report.margins) {
    if (report.feasible && !(margin >= 0)) {
      report.reason = "limit " + name + " is broken";
      if (name == "clearance_min")
        report.reason += ": " + link_name(nearest.first, g.platform) + " and " + link_name(nearest.second, g.platform) +
                         (nearest.clearance < 0 ? " overlap" : " are too near");
    }
    report.feasible = report.feasible && margin >= 0;
  }
  return report;
}

}  // namespace pkm::crr_cru
