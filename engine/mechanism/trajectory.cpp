#include "engine/mechanism/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "engine/mechanism/drive_along.hpp"

namespace pkm {
namespace {

bool is_finite(const Vector<double, 4>& x) {
  return std::all_of(x.m.begin(), x.m.end(), [](double value) { return std::isfinite(value); });
}

TrajectorySummary summarise(const std::vector<TrajectoryPoint>& points) {
  TrajectorySummary s;
  s.has_forces = std::all_of(points.begin(), points.end(), [](const auto& p) { return p.forces.has_value(); });
  const auto n = static_cast<double>(points.size());
  double drawn_before = 0, total_before = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const TrajectoryPoint& p = points[k];
    if (!p.feasible) ++s.infeasible;
    for (std::size_t i = 0; p.speeds && i < 4; ++i)
      s.peak_speed[i] = std::fmax(s.peak_speed[i], std::fabs((*p.speeds)[i]));
    if (!s.has_forces) continue;
    double total = 0, drawn = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double tau = (*p.forces)[i], power = (*p.power)[i];
      s.peak_force[i] = std::fmax(s.peak_force[i], std::fabs(tau));
      s.rms_force[i] += tau * tau / n;
      s.peak_power[i] = std::fmax(s.peak_power[i], std::fabs(power));
      total += power;
      drawn += std::fmax(power, 0);
    }
    s.peak_total_power = k == 0 ? total : std::fmax(s.peak_total_power, total);
    s.least_total_power = k == 0 ? total : std::fmin(s.least_total_power, total);
    if (k > 0) {
      const double half_step = (p.motion.time - points[k - 1].motion.time) / 2;
      s.energy += half_step * (total + total_before);
      s.energy_drawn += half_step * (drawn + drawn_before);
    }
    total_before = total;
    drawn_before = drawn;
  }
  for (double& force : s.rms_force.m) force = std::sqrt(force);
  return s;
}

}  // namespace

Trajectory follow(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                  const LimitSpec& limits, const Motion& motion, std::size_t count, const Wrench<double>& wrench,
                  double phase) {
  const bool has_dynamics = mechanism.info().has_dynamics, has_chain = !mechanism.info().chain_input.empty();
  Trajectory trajectory;
  trajectory.duration = motion.duration();
  trajectory.periodic = is_periodic(motion);
  for (const MotionSample& at : sample(motion, count)) {
    TrajectoryPoint point;
    point.motion = at;
    if (!is_finite(at.pose) || !is_finite(at.velocity) || !is_finite(at.acceleration) ||
        !is_finite({{at.input.angle, at.input.speed, at.input.acceleration, 0}})) {
      point.reason = "the motion has no finite pose, velocity and acceleration";
      trajectory.points.push_back(std::move(point));
      continue;
    }
    PoseReport report = mechanism.inspect(parameters, at.as_pose(), mode, limits);
    point.feasible = report.feasible;
    point.reason = std::move(report.reason);
    if (!point.feasible && point.reason.empty()) point.reason = "not feasible";
    point.conditioning = report.conditioning;
    if (report.joints) point.joints = {{(*report.joints)}};
    if (has_dynamics && report.assembles) {
      drive_along<double>(mechanism, parameters, mode, {&at, 1}, wrench, [&](std::size_t, const Drive<double>& drive) {
        point.speeds = drive.speeds;
        point.accelerations = drive.accelerations;
        if (!is_finite(drive.forces)) return;
        point.forces = drive.forces;
        point.power.emplace();
        for (std::size_t i = 0; i < 4; ++i) (*point.power)[i] = drive.power(i);
      });
    } else if (mechanism.info().has_influence) {
      if (const auto joints = mechanism.influence(parameters, at.as_pose(), mode)) {
        point.speeds = joints->G * at.velocity;
        point.accelerations = accelerations(*joints, at.velocity, at.acceleration);
      }
    }
    if (has_chain) point.chain = mechanism.chain(parameters, at, phase);
    trajectory.points.push_back(std::move(point));
  }
  trajectory.summary = summarise(trajectory.points);
  return trajectory;
}

}  // namespace pkm
