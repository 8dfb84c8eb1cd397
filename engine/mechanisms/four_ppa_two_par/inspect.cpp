#include "engine/mechanisms/four_ppa_two_par/inspect.hpp"

#include <Eigen/LU>

#include "engine/mechanisms/four_ppa_two_par/links.hpp"
#include "engine/mechanisms/four_ppa_two_par/margins.hpp"
#include "engine/model/conditioning.hpp"

namespace pkm::four_ppa_two_par {
namespace {

std::string out_of_reach(const Limbs<double>& limb, const std::array<double, kMargins>& margin) {
  for (std::size_t j = 0; j < 2; ++j) {
    const std::string number = std::to_string(j + 1), name = "limb " + number;
    if (limb.x[j] < 0) return name + ": x_" + number + " < 0, the platform is beyond the rail's vertical plane";
    if (margin[kReachX + j] < 0) return name + ": out of reach of the lower bars (x_" + number + " > l_d)";
    if (margin[kReachZ + j] < 0) return name + ": out of reach of the upper bars (|z_c| > l_u)";
  }
  return {};
}

void add_velocities(const Geometry<double>& g, const Velocity<double>& v, PoseReport& report) {
  report.G = v.G;
  report.det_G = v.G.determinant();
  report.conditioning = 0;
  if (!v.finite) return;
  report.Jq = v.Jq;
  report.det_Jq = v.k[0] * v.k[1] / 4;
  if (*report.det_Jq == 0) return;
  const Eigen::Matrix4d J = v.Jq.inverse() * v.G;
  report.J = J;
  double columns[4][4];
  for (int col = 0; col < 4; ++col)
    for (int row = 0; row < 4; ++row) columns[col][row] = J(row, col) * (col == 3 ? 2 / g.a : 1);  // L_c = a/2
  report.conditioning = inverse_condition(columns);
}

}  // namespace

PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Obstacles& obstacles,
                   const Pose<double>& pose, WorkingMode mode) {
  PoseReport report;
  const Limbs<double> limb = inverse(g, pose, mode);
  report.assembles = limb.assembles;
  const double c = sincos(pose.angle).cos;
  report.angles.emplace_back("section_type", section_type(g, c));
  std::array<double, kMargins> margin = margins(g, l, limb, c, mode);
  const auto list = [&](std::size_t index) { report.margins.emplace_back(kMarginNames[index], margin[index]); };
  if (!limb.assembles) {
    report.reason = out_of_reach(limb, margin);
    for (std::size_t j = 0; j < 2; ++j) list(kReachX + j), list(kReachZ + j);
    return report;
  }
  report.T = schoenflies_twist(2);
  report.joints = {limb.q[0], limb.q[1], limb.q[2], limb.q[3]};
  add_velocities(g, velocity(g, pose, limb, mode), report);
  for (std::size_t j = 0; j < 2; ++j) report.angles.emplace_back("alpha_" + std::to_string(j + 1), alpha(limb, j));
  for (std::size_t j = 0; j < 2; ++j)
    report.angles.emplace_back("beta_" + std::to_string(j + 1), beta(limb, j, mode[j]));
  for (std::size_t j = 0; j < 2; ++j) report.angles.emplace_back("z_c_" + std::to_string(j + 1), limb.z_c[j]);
  const Links<double> all = links(g, placement(limb, sincos(pose.angle).sin, mode));
  Nearest<double> nearest = nearest_links(all);
  const Nearest<double> other = nearest_obstacle(all, pose.y, obstacles);
  const bool is_obstacle = other.clearance < nearest.clearance;
  if (is_obstacle) nearest = other;
  report.angles.emplace_back("clearance", nearest.clearance);
  if (l.clearance_min) margin[kFirstLimit + kClearanceMin] = nearest.clearance - *l.clearance_min;

  report.feasible = true;
  for (std::size_t i = 0; i < kMargins; ++i) {
    const bool clearance = i == kFirstLimit + kClearanceMin;
    if (clearance && !l.clearance_min) continue;
    list(i);
    if (report.feasible && !(margin[i] >= 0)) {
      report.reason = std::string("limit ") + kMarginNames[i] + " is broken";
      if (clearance)
        report.reason += ": " + link_name(nearest.first) + " and " +
                         (is_obstacle ? obstacles[nearest.second].name : link_name(nearest.second)) +
                         (nearest.clearance < 0 ? " overlap" : " are too near");
    }
    report.feasible = report.feasible && margin[i] >= 0;
  }
  return report;
}

}  // namespace pkm::four_ppa_two_par
