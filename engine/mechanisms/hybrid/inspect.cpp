#include "engine/mechanisms/hybrid/inspect.hpp"

#include <algorithm>
#include <limits>

#include "engine/mechanisms/hybrid/influence.hpp"

namespace pkm::hybrid {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

constexpr unsigned bit(std::size_t limb) { return 1u << limb; }

const char* const kLimbs[3] = {"A", "B", "C"};

std::string out_of_reach(const Joints<double>& j) {
  std::string reason;
  for (std::size_t limb = 0; limb < 3; ++limb)
    if (j.unreached & bit(limb))
      reason += std::string(reason.empty() ? "" : "; ") + "limb " + kLimbs[limb] + ": out of reach of its link (" +
                kLimbs[limb] + "' is farther than L" + std::to_string(limb + 1) + " from its rail)";
  return reason;
}

/// What depends on the platform's and the limbs' velocities alone.
void add_velocity(const Geometry<double>& g, const Pose<double>& pose, const Joints<double>& j, PoseReport& report) {
  const VelocityEquation<double> v = velocity_equation(pose, j);
  report.Jq = v.Jq;
  report.G = v.Jx;
  report.T = schoenflies_twist(0);
  report.det_Jq = j.n1 * j.n2 * j.n3;
  report.det_G = pose.z * (j.n1 - j.n2) * j.N2;
  report.conditioning = 0;
  if (j.serial) return;
  report.J = influence(g, pose, j).G;
  const Rows3<double> J = homogeneous_jacobian(pose.z, j, g.e);  // L_c = e
  report.conditioning = inverse_condition(J);
  const ExtremeSingularValues<double> s = extreme_singular_values(J);
  const bool has_pair = s.pair_2 > 0;  // else J has rank 1, and sigma_2 = 0
  report.indices = {{"sigma_1", std::sqrt(s.greatest_2)},
                    {"sigma_2", has_pair ? std::sqrt(s.pair_2 / s.greatest_2) : 0},
                    {"sigma_3", has_pair ? std::sqrt(s.least_2()) : 0}};
}

/// Measures of transmission, and of the chain at the phase 0.
void add_transmission(const Geometry<double>& g, const Pose<double>& pose, const Joints<double>& j,
                      PoseReport& report) {
  const Transmission<double> t = transmission(g, pose.z, j);
  for (std::size_t i = 0; i < 3; ++i) report.indices.emplace_back("t_" + std::to_string(i + 1), t.t[i]);
  report.indices.emplace_back("t_xz", t.t_xz);
  report.indices.emplace_back("t_beta", std::fabs(t.t_beta));
  report.indices.emplace_back("t_con", std::fabs(t.sin_lambda));
  report.indices.emplace_back("LTI", local_transmission_index(t));
  for (std::size_t i = 0; i < 3; ++i) report.angles.emplace_back("pressure_" + std::to_string(i + 1), acos(t.t[i]));
  report.angles.emplace_back("lambda", t.lambda);
  report.angles.emplace_back("mu", wrapped(t.lambda - pose.angle));
  const Forks<double> forks = hybrid::forks(shaft(g, pose), pose.angle, 0);
  if (!forks.turns) return;
  const Ratio<double> r = ratio(forks);
  report.indices.emplace_back("aux_ratio_min", r.least);
  report.indices.emplace_back("aux_ratio_max", r.greatest);
}

}  // namespace

PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Obstacles& obstacles,
                   const Pose<double>& pose, const WorkingMode& mode, int branch) {
  PoseReport report;
  const Joints<double> j = inverse(g, pose, mode);
  const Margins<double> m = margins(g, l, pose, mode, branch);
  report.assembles = j.assembles();
  report.joints = {j.s[0], j.s[1], j.s[2], j.s[3]};
  for (std::size_t limb = 0; limb < 3; ++limb)
    if (j.unreached & bit(limb)) (*report.joints)[kDriveOfLimb[limb]] = kAbsent;
  for (std::size_t i = 0; i < kMargins; ++i)
    report.margins.emplace_back(kMarginNames[i].name, report.assembles || i <= kReach3 ? m[i] : kAbsent);
  if (!report.assembles) {
    report.reason = out_of_reach(j);
    return report;
  }
  add_velocity(g, pose, j, report);
  add_transmission(g, pose, j, report);
  const auto broken = std::ranges::find_if(m, [](double margin) { return !(margin >= 0); });
  if (broken != m.end())
    report.reason =
        "limit " + std::string(kMarginNames[static_cast<std::size_t>(broken - m.begin())].name) + " is broken";
  else if (!(pose.z > 0))
    report.reason = "the platform is not above the base";
  if (!obstacles.empty()) {
    const auto [clearance, link, obstacle] = nearest_obstacle(g, pose, j, shaft(g, pose), obstacles);
    report.margins.emplace_back(kObstacleMargin, clearance - l.clearance_min);
    if (report.reason.empty() && !(clearance >= l.clearance_min))
      report.reason = "limit " + std::string(kObstacleMargin) + " is broken: " + kLinkNames[link] + " and " +
                      obstacles[obstacle].name + (clearance < 0 ? " overlap" : " are too near");
  }
  report.feasible = report.reason.empty();
  return report;
}

}  // namespace pkm::hybrid
