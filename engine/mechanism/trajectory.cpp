#include "engine/mechanism/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/mechanism/redundant_drives.hpp"

namespace pkm {
namespace {

bool is_finite(const AxisVector<double>& x) {
  return std::ranges::all_of(x, [](double value) { return std::isfinite(value); });
}

TrajectorySummary summarise(const std::vector<TrajectoryPoint>& points, std::size_t joints) {
  TrajectorySummary s;
  s.peak_force = s.rms_force = s.peak_power = AxisVector<double>(joints);
  s.peak_torque = s.rms_torque = s.peak_motor_speed = AxisVector<double>(joints);
  s.has_forces = std::ranges::all_of(points, [](const auto& p) { return p.forces.has_value(); });
  const auto n = static_cast<double>(points.size());
  double drawn_before = 0, total_before = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const TrajectoryPoint& p = points[k];
    if (!p.feasible) ++s.infeasible;
    if (p.speeds && !s.peak_speed) s.peak_speed = AxisVector<double>(joints);
    for (std::size_t i = 0; p.speeds && i < joints; ++i)
      (*s.peak_speed)[i] = std::fmax((*s.peak_speed)[i], std::fabs((*p.speeds)[i]));
    if (!s.has_forces) continue;
    double total = 0, drawn = 0;
    for (std::size_t i = 0; i < joints; ++i) {
      const double tau = (*p.forces)[i], power = (*p.power)[i];
      s.peak_force[i] = std::fmax(s.peak_force[i], std::fabs(tau));
      s.rms_force[i] += tau * tau / n;
      s.peak_power[i] = std::fmax(s.peak_power[i], std::fabs(power));
      total += power;
      drawn += std::fmax(power, 0);
      if (!p.torques) continue;
      s.peak_torque[i] = std::fmax(s.peak_torque[i], std::fabs((*p.torques)[i]));
      s.rms_torque[i] += (*p.torques)[i] * (*p.torques)[i] / n;
      s.peak_motor_speed[i] = std::fmax(s.peak_motor_speed[i], std::fabs((*p.motor_speeds)[i]));
    }
    s.peak_total_power = k == 0 ? total : std::fmax(s.peak_total_power, total);
    s.min_total_power = k == 0 ? total : std::fmin(s.min_total_power, total);
    if (k > 0) {
      const double half_step = (p.motion.time - points[k - 1].motion.time) / 2;
      s.energy += half_step * (total + total_before);
      s.energy_drawn += half_step * (drawn + drawn_before);
    }
    total_before = total;
    drawn_before = drawn;
  }
  for (double& force : s.rms_force) force = std::sqrt(force);
  for (double& torque : s.rms_torque) torque = std::sqrt(torque);
  return s;
}

/// Stores the joint speeds if all of them are finite, and the accelerations if all of them are finite.
void set_rates(TrajectoryPoint& point, const AxisVector<double>& speeds, const AxisVector<double>& accelerations) {
  if (is_finite(speeds)) point.speeds = speeds;
  if (is_finite(accelerations)) point.accelerations = accelerations;
}

void mark_infeasible(TrajectoryPoint& point, const std::string& reason) {
  point.reason += (point.feasible ? "" : "; ") + reason;
  point.feasible = false;
}
void mark_singular(TrajectoryPoint& point) { mark_infeasible(point, "the Jacobian is singular to working precision"); }

}  // namespace

Trajectory compute_trajectory(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                              const LimitSpec& limits, const Motion& motion, std::size_t count,
                              const Wrench<double>& wrench) {
  const MechanismInfo& info = mechanism.info();
  const Dynamics* const dynamics = why_no_drive_forces(mechanism) ? nullptr : mechanism.dynamics();
  const DriveLimits force_limits = drive_limits(mechanism, parameters);
  const DriveTrains* const trains = mechanism.drive_trains();
  const Velocities* const velocities = mechanism.velocities();
  InverseDynamicsScratch<double> scratch;
  Trajectory trajectory;
  trajectory.duration = motion.duration();
  trajectory.periodic = is_periodic(motion, info.coordinates);
  for (const MotionSample& at : sample(motion, count)) {
    TrajectoryPoint point;
    point.motion = at;
    if (!is_finite(at.pose) || !is_finite(at.velocity) || !is_finite(at.acceleration) ||
        !std::ranges::all_of(at.inputs, [](const InputSample& input) {
          return is_finite({input.value, input.rate, input.acceleration});
        })) {
      point.reason = "the pose, velocity or acceleration of the motion is not finite";
      trajectory.points.push_back(std::move(point));
      continue;
    }
    PoseReport report = mechanism.inspect(parameters, at.pose, mode, limits);
    point.feasible = report.feasible;
    point.reason = std::move(report.reason);
    if (!point.feasible && point.reason.empty()) point.reason = "not feasible";
    point.conditioning = report.conditioning;
    point.joints = report.joints;
    if (dynamics && report.assembles) {
      const auto visit = [&](std::size_t, const MotionState<double>& state, const PoseDynamics<double>& d) {
        ActuatorState<double> drive{d.q, d.J * state.velocity, d.J * at.acceleration + d.J_rate_X, {}};
        set_rates(point, drive.speeds, drive.accelerations);
        const auto [forces, reason] = distributed_forces(d, at.acceleration, wrench, force_limits);
        if (!forces) {
          mark_infeasible(point, reason);
          return true;
        }
        drive.forces = *forces;
        point.forces = drive.forces;
        point.power = AxisVector<double>(drive.forces.size());
        for (std::size_t i = 0; i < drive.forces.size(); ++i) (*point.power)[i] = drive.power(i);
        if (!trains) return true;
        point.torques = point.motor_speeds = AxisVector<double>(drive.forces.size());
        for (std::size_t i = 0; i < drive.forces.size(); ++i) {
          (*point.torques)[i] = drive.torque((*trains)[i], i);
          (*point.motor_speeds)[i] = drive.speeds[i] * (*trains)[i].ratio;
        }
        return true;
      };
      equations_along<double>(*dynamics, parameters, mode, std::span(&at, 1), scratch, visit);
    } else if (velocities && report.assembles) {
      const auto joints = velocities->influence(parameters, at.pose, mode);
      if (joints) set_rates(point, joints->G * at.velocity, accelerations(*joints, at.velocity, at.acceleration));
      if (!joints || (joints->G.rows() >= joints->G.cols() && is_rank_deficient(joints->G))) mark_singular(point);
    }
    point.quantities = mechanism.quantities(parameters, mode, limits, at);
    trajectory.points.push_back(std::move(point));
  }
  trajectory.summary = summarise(trajectory.points, info.joints.size());
  return trajectory;
}

NamedValues pose_quantities_of(const MechanismInfo& info, const std::vector<double>& values) {
  NamedValues named;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!info.quantities[i].of_design) named.emplace_back(info.quantities[i].name, values[i]);
  return named;
}

NamedValues input_and_quantity_values(const MechanismInfo& info, const TrajectoryPoint& point) {
  NamedValues values;
  for (std::size_t i = 0; i < point.motion.inputs.size(); ++i) {
    const auto& [value, rate, acceleration] = point.motion.inputs[i];
    const std::string& name = info.inputs[i].name;
    values.insert(values.end(), {{name, value}, {name + "_speed", rate}, {name + "_acceleration", acceleration}});
  }
  const NamedValues quantities = pose_quantities_of(info, point.quantities);
  values.insert(values.end(), quantities.begin(), quantities.end());
  return values;
}

}  // namespace pkm
