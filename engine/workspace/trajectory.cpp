#include "engine/workspace/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "engine/workspace/drive_along.hpp"

namespace pkm {
namespace {

bool is_finite(const Vector<double, 4>& x) {
  return std::all_of(x.m.begin(), x.m.end(), [](double value) { return std::isfinite(value); });
}

Vector<double, 4> product(const Eigen::Matrix4d& J, const Vector<double, 4>& x) {
  Vector<double, 4> y;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) y[i] += J(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * x[j];
  return y;
}

/// Jdot Xdot by differences of J Xdot along Xdot; none where a neighbour has no J.
template <class JacobianAt>
std::optional<Vector<double, 4>> rate_term(const MotionSample& at, const JacobianAt& jacobian_at) {
  double speed = 0;
  for (const double v : at.velocity.m) speed = std::fmax(speed, std::fabs(v));
  if (speed == 0) return Vector<double, 4>{};
  const double h = 1e-3 / speed;
  const auto moved = [&](double steps) -> std::optional<Vector<double, 4>> {
    MotionSample near = at;
    near.pose += at.velocity * (steps * h);
    const auto J = jacobian_at(near.as_pose());
    if (!J) return std::nullopt;
    return product(*J, at.velocity);
  };
  const auto m2 = moved(-2), m1 = moved(-1), p1 = moved(1), p2 = moved(2);
  if (!m2 || !m1 || !p1 || !p2) return std::nullopt;
  return ((*p1 - *m1) * 8.0 - (*p2 - *m2)) * (1 / (12 * h));
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
                  const LimitSpec& limits, const Motion& motion, std::size_t count, const Wrench<double>& wrench) {
  const auto inspect = [&](const Pose<double>& pose) { return mechanism.inspect(parameters, pose, mode, limits); };
  const bool has_dynamics = mechanism.info().has_dynamics;
  Trajectory trajectory;
  trajectory.duration = motion.duration();
  trajectory.periodic = is_periodic(motion);
  for (const MotionSample& at : sample(motion, count)) {
    TrajectoryPoint point;
    point.motion = at;
    if (!is_finite(at.pose) || !is_finite(at.velocity) || !is_finite(at.acceleration)) {
      point.reason = "the motion has no finite pose, velocity and acceleration";
      trajectory.points.push_back(std::move(point));
      continue;
    }
    PoseReport report = inspect(at.as_pose());
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
    } else if (report.J) {
      point.speeds = product(*report.J, at.velocity);
      if (const auto rate = rate_term(at, [&](const Pose<double>& pose) { return inspect(pose).J; }))
        point.accelerations = product(*report.J, at.acceleration) + *rate;
    }
    trajectory.points.push_back(std::move(point));
  }
  trajectory.summary = summarise(trajectory.points);
  return trajectory;
}

}  // namespace pkm
