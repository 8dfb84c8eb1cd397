#include "engine/results/task_motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/mechanism/motor_demand.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {
namespace {

using JointValues = std::optional<AxisVector<double>> TrajectoryPoint::*;

/// A load of the drives that is compared among drives of one kind.
struct LoadKind {
  const char *speed, *force;            ///< names of the speed and of the force
  const char *speed_unit, *force_unit;  ///< SI units of the speed and of the force
  bool turns;
};
constexpr LoadKind kLoadKinds[] = {{"angular speed", "torque", "rad/s", "N m", true},
                                   {"speed", "force", "m/s", "N", false}};

std::string place_of(const TrajectoryPoint& point) { return "at t = " + with_unit(point.motion.time, "s"); }

/// The reason why a quantity of the joints is undefined along the motion, with the sample at which it is undefined.
std::string why_undefined_along(const Trajectory& found, JointValues values) {
  if (found.points.empty()) return "the robot refuses the motion";
  for (const TrajectoryPoint& point : found.points)
    if (!(point.*values))
      return "the motion is impossible " + place_of(point) + (point.reason.empty() ? "" : ": " + point.reason);
  return {};
}

/// For the joints of one kind: maximum of the magnitude over all joints and samples, and maximum over the joints of the
/// root mean square over the samples. Every sample must have a value.
struct PeakAndRms {
  double peak = 0, rms = 0;
};
PeakAndRms peak_and_rms(const std::vector<AxisInfo>& joints, bool turns, const Trajectory& found, JointValues values) {
  PeakAndRms result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].turns() != turns) continue;
    double sum = 0;
    for (const TrajectoryPoint& point : found.points) {
      const double value = (*(point.*values))[i];
      result.peak = std::fmax(result.peak, std::fabs(value));
      sum += value * value;
    }
    result.rms = std::fmax(result.rms, std::sqrt(sum / static_cast<double>(found.points.size())));
  }
  return result;
}

/// The smallest ratio of capacity to demand over all limits of the drives, and the limit that has it.
TaskValue drive_reserve(TaskValue line, const Mechanism& mechanism, const Trajectory& found) {
  const std::vector<JointLimits> limits = joint_limits(mechanism);
  const auto& joints = mechanism.info().joints;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double reserve, const std::string& limit, std::size_t joint) {
    if (!(reserve < least)) return;
    least = reserve;
    line.limited_by = limit + " of " + joints[joint].name;
  };
  const auto consider_peak = [&](double capacity, JointValues values, const std::string& limit, std::size_t joint) {
    if (!std::isfinite(capacity)) return;
    for (const TrajectoryPoint& point : found.points)
      if (point.*values) consider(capacity / std::fabs((*(point.*values))[joint]), limit, joint);
  };
  const DriveTrains* const trains = mechanism.drive_trains();
  const bool has_motors =
      trains && std::ranges::any_of(limits, [](const JointLimits& limit) { return limit.motor.has_value(); });
  const bool needs_forces =
      has_motors || std::ranges::any_of(limits, [](const auto& limit) { return std::isfinite(limit.force); });
  line.reason = why_undefined_along(found, needs_forces ? &TrajectoryPoint::forces : &TrajectoryPoint::accelerations);
  if (!line.reason.empty()) return line;
  const auto loads = has_motors ? joint_loads(*trains, found) : std::vector<std::vector<JointLoad>>();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    consider_peak(limits[i].speed, &TrajectoryPoint::speeds, "speed", i);
    consider_peak(limits[i].acceleration, &TrajectoryPoint::accelerations, "acceleration", i);
    consider_peak(limits[i].force, &TrajectoryPoint::forces, joints[i].turns() ? "torque" : "force", i);
    if (!limits[i].motor) continue;
    const MotorFit fitted = fit(*limits[i].motor, (*trains)[i], loads[i]);
    consider(fitted.reserve, fitted.bounded_by + " of the motor", i);
  }
  if (std::isfinite(least))
    line.value = least;
  else
    line.reason = "the drives have no limits: neither the task nor the study has [[drive_train]] with them";
  return line;
}

/// Minimum of a value over the samples, or the reason why it is undefined.
template <class ValueOf>
void set_minimum(TaskValue& line, const Trajectory& found, const ValueOf& value_of) {
  if (found.points.empty()) return;
  double least = std::numeric_limits<double>::infinity();
  for (const TrajectoryPoint& point : found.points) {
    const double value = value_of(point);
    if (std::isnan(value)) {
      line.reason = why_impossible(found);
      if (line.reason.empty()) line.reason = "the value is undefined " + place_of(point);
      return;
    }
    least = std::fmin(least, value);
  }
  line.value = least;
}

}  // namespace

std::vector<TaskValue> values_along(const std::string& motion, const Mechanism& mechanism, const Trajectory& found,
                                    bool needs_drives, const Unsupported& why_no_drives) {
  const MechanismInfo& info = mechanism.info();
  std::vector<TaskValue> lines;
  const auto add = [&](const std::string& name, const std::string& unit) -> TaskValue& {
    return lines.emplace_back(TaskValue{.group = motion, .name = motion + ": " + name, .unit = unit});
  };
  const Unsupported no_forces = why_no_joint_forces(mechanism);

  TaskValue& conditioning = add("conditioning, min", "1");
  if (const Unsupported reason = why_no_conditioning(info))
    conditioning.reason = *reason;
  else
    set_minimum(conditioning, found, [](const auto& point) { return point.conditioning.value_or(std::nan("")); });
  TaskValue& lti = add("lti, min", "1");
  const auto index = std::ranges::find(info.quantities, "lti", &QuantityInfo::name) - info.quantities.begin();
  if (index < std::ssize(info.quantities)) {
    set_minimum(lti, found, [index](const auto& point) {
      return point.quantities.empty() ? std::nan("") : point.quantities[static_cast<std::size_t>(index)];
    });
  } else {
    const UndefinedQuantity* const undefined = find_named(info.undefined_quantities, "lti");
    lti.reason = undefined ? undefined->why : "the mechanism has no quantity 'lti'";
  }

  for (const LoadKind& kind : kLoadKinds) {
    const bool has_joints =
        std::ranges::any_of(info.joints, [&](const auto& joint) { return joint.turns() == kind.turns; });
    const auto add_loads = [&](const std::string& name, const std::string& unit, JointValues values,
                               const Unsupported& unsupported) {
      TaskValue peak = add("peak " + name, unit), rms = add("RMS " + name, unit);
      std::string reason = !has_joints   ? std::string("no drive is ") + (kind.turns ? "revolute" : "prismatic")
                           : unsupported ? *unsupported
                                         : why_undefined_along(found, values);
      if (reason.empty()) {
        const PeakAndRms loads = peak_and_rms(info.joints, kind.turns, found, values);
        peak.value = loads.peak;
        rms.value = loads.rms;
      }
      peak.reason = rms.reason = reason;
      lines[lines.size() - 2] = peak;
      lines[lines.size() - 1] = rms;
    };
    add_loads(kind.speed, kind.speed_unit, &TrajectoryPoint::speeds, {});
    add_loads(kind.force, kind.force_unit, &TrajectoryPoint::forces, no_forces);
  }

  const std::string why_no_power = no_forces ? *no_forces : why_undefined_along(found, &TrajectoryPoint::power);
  const auto add_power = [&](const std::string& name, double value) {
    TaskValue& line = add(name, "W");
    line.reason = why_no_power;
    if (why_no_power.empty()) line.value = value;
  };
  const TrajectorySummary& summary = found.summary;
  add_power("peak power, one drive", why_no_power.empty() ? std::ranges::max(summary.peak_power) : 0);
  add_power("peak power, all drives", std::fmax(summary.peak_total_power, -summary.min_total_power));

  TaskValue reserve{.group = motion, .name = motion + ": reserve of the drives", .unit = "1"};
  if (needs_drives) reserve.required = 1;
  if (why_no_drives) {
    reserve.reason = *why_no_drives;
    lines.push_back(reserve);
  } else {
    lines.push_back(drive_reserve(reserve, mechanism, found));
  }
  return lines;
}

std::string why_impossible(const Trajectory& found) { return why_undefined_along(found, &TrajectoryPoint::speeds); }

std::vector<TaskCurve> curves_along(const Mechanism& mechanism, const Trajectory& found) {
  const auto& joints = mechanism.info().joints;
  std::vector<TaskCurve> curves;
  const auto add = [&](const std::string& name, const std::string& unit, JointValues values, const auto& value_of) {
    TaskCurve curve{name, unit, {}};
    for (const TrajectoryPoint& point : found.points)
      curve.values.push_back(point.*values ? value_of(*(point.*values)) : std::nan(""));
    const auto is_known = [](double value) { return !std::isnan(value); };
    if (std::ranges::any_of(curve.values, is_known)) curves.push_back(std::move(curve));
  };
  add("power of all drives", "W", &TrajectoryPoint::power, [](const AxisVector<double>& power) {
    double sum = 0;
    for (const double each : power) sum += each;
    return sum;
  });
  for (const LoadKind& kind : kLoadKinds) {
    if (std::ranges::none_of(joints, [&](const auto& joint) { return joint.turns() == kind.turns; })) continue;
    const auto largest = [&](const AxisVector<double>& values) {
      double peak = 0;
      for (std::size_t i = 0; i < joints.size(); ++i)
        if (joints[i].turns() == kind.turns) peak = std::fmax(peak, std::fabs(values[i]));
      return peak;
    };
    add(std::string("largest ") + kind.force, kind.force_unit, &TrajectoryPoint::forces, largest);
    add(std::string("largest ") + kind.speed, kind.speed_unit, &TrajectoryPoint::speeds, largest);
  }
  return curves;
}

}  // namespace pkm
