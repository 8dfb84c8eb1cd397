#include "engine/mechanism/path_limits.hpp"

#include <algorithm>

#include "engine/math/roots.hpp"

namespace pkm {

const char* name_of(LimitKind kind) {
  switch (kind) {
    case LimitKind::joint_speed:
      return "joint speed";
    case LimitKind::joint_acceleration:
      return "joint acceleration";
    case LimitKind::force:
      return "force";
    case LimitKind::motor_speed:
      return "motor speed";
    case LimitKind::peak_torque:
      return "peak torque";
    case LimitKind::continuous_torque:
      return "continuous torque";
    case LimitKind::tool_speed:
      return "tool speed";
    case LimitKind::tool_acceleration:
      return "tool acceleration";
  }
  return "";
}

Unsupported why_no_limits(const Mechanism& mechanism, const MotionLimits& limits) {
  const Unsupported no_forces = why_no_joint_forces(mechanism);
  const std::string name = "mechanism " + mechanism.info().name;
  if (no_forces && !mechanism.velocities())
    return "the fastest motion needs joint speeds, and " + name + " has neither influence coefficients nor masses";
  for (std::size_t i = 0; i < limits.joints.size(); ++i) {
    const JointLimits& joint = limits.joints[i];
    const std::string& of = mechanism.info().joints[i].name;
    if (std::isnan(joint.force))
      return "peak_force of joint " + of + " is a formula; the fastest motion needs a number";
    if (no_forces && (std::isfinite(joint.force) || joint.motor))
      return "limits of forces need dynamics, and " + *no_forces;
    if (joint.motor && !mechanism.drive_trains())
      return "the motor of joint " + of + " needs a drive train, and " + name +
             " has none; define them in the study in [[drive_train]]";
  }
  return {};
}

AccelerationInterval<double> acceleration_interval(const PathPoint<double>& p, double y, const MotionLimits& limits,
                                                   const DriveTrains* trains, double scale) {
  AccelerationInterval<double> found;
  int number = 0;
  visit_linear_limits(p, y, limits, trains, [&](const LimitOfMotion&, const LinearLimit<double>& limit) {
    const int here = number++;
    const double room = scale * limit.limit - limit.offset;
    if (limit.slope == 0) {
      if (room >= 0) return;
      found.upper = -std::numeric_limits<double>::infinity();
      found.at_upper = here;
      return;
    }
    const double end = room / limit.slope;
    if (limit.slope > 0 && end < found.upper) {
      found.upper = end;
      found.at_upper = here;
    } else if (limit.slope < 0 && end > found.lower) {
      found.lower = end;
      found.at_lower = here;
    }
  });
  return found;
}

LargestSquare largest_square(const PathPoint<double>& p, const MotionLimits& limits, const DriveTrains* trains) {
  LargestSquare found;
  int number = 0;
  visit_speed_bounds(p, limits, trains, [&](const LimitOfMotion&, const SpeedBound<double>& bound) {
    if (bound.bound < found.y) found = {bound.bound, number};
    ++number;
  });
  return found;
}

Violation largest_violation(const PathPoint<double>& p, double y, double u, const MotionLimits& limits,
                            const DriveTrains* trains) {
  Violation largest{.value = -std::numeric_limits<double>::infinity()};
  int number = 0;
  visit_speed_bounds(p, limits, trains, [&](const LimitOfMotion& limit, const SpeedBound<double>& bound) {
    const double value = y / bound.bound - 1;
    if (value > largest.value) largest = {value, limit, true, number};
    ++number;
  });
  number = 0;
  visit_linear_limits(p, y, limits, trains, [&](const LimitOfMotion& which, const LinearLimit<double>& limit) {
    const double value = limit.violation(u);
    if (value > largest.value) largest = {value, which, false, number};
    ++number;
  });
  return largest;
}

double largest_factor(const PathPoint<double>& p, double y, double u, const MotionLimits& limits,
                      const DriveTrains* trains, double upper) {
  const auto reserve = [&](double factor) {
    return -largest_violation(p, factor * y, factor * u, limits, trains).value;
  };
  const double at_upper = reserve(upper);
  if (at_upper >= 0) return upper;
  const double at_rest = reserve(0);
  if (!(at_rest >= 0)) return -1;
  return refine_root(reserve, 0, at_rest, upper, at_upper, 0);
}

}  // namespace pkm
