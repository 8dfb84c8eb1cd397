// Limits of a motion at a point of its path (path_point.hpp). For a given squared path speed y, every limit of joint
// acceleration, force and motor torque is linear in the path acceleration u; limits of speed, and the limit of the
// tool's acceleration where the path is curved, are upper bounds of y.
//
// The torque of a motor with the efficiency eta < 1 is the maximum (n >= 0) or the minimum (n < 0) of two linear
// functions of u (drive_train.hpp). Its limit on the convex side is two linear inequalities, of which both have to
// hold; on the other side one of them is sufficient.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/dynamics/joint_limits.hpp"
#include "engine/mechanism/path_point.hpp"

namespace pkm {

enum class LimitKind {
  joint_speed,
  joint_acceleration,
  force,
  motor_speed,
  peak_torque,
  continuous_torque,
  tool_speed,
  tool_acceleration
};

/// Name of a kind of limit in reports and JSON, for example "joint speed".
const char* name_of(LimitKind kind);
/// Returns true if the limit belongs to a joint, false if it belongs to the tool.
inline bool is_of_joint(LimitKind kind) {
  return kind != LimitKind::tool_speed && kind != LimitKind::tool_acceleration;
}

struct LimitOfMotion {
  LimitKind kind = LimitKind::joint_speed;
  std::size_t joint = 0;  ///< index of the joint; 0 if the limit belongs to the tool
  bool operator==(const LimitOfMotion&) const = default;
};

struct MotionLimits {
  std::vector<JointLimits> joints;  ///< limits of each joint; empty if there are none
  /// Maximum magnitude of the velocity of all coordinates that are lengths [m/s].
  double tool_speed = std::numeric_limits<double>::infinity();
  /// Maximum magnitude of the acceleration of all coordinates that are lengths [m/s^2].
  double tool_acceleration = std::numeric_limits<double>::infinity();
};

/// The reason why a mechanism does not support the limits, as a sentence; empty if it supports them.
Unsupported why_no_limits(const Mechanism& mechanism, const MotionLimits& limits);

/// The inequality slope * u + offset <= limit for the path acceleration u. Violations are divided by `scale` > 0.
template <class S>
struct LinearLimit {
  S slope, offset, limit;
  double scale;

  S violation(const S& u) const { return (slope * u + offset - limit) / scale; }
};

/// The inequality y <= bound for the squared path speed y.
template <class S>
struct SpeedBound {
  S bound;
};

/// Calls visit(LimitOfMotion, LinearLimit<S> or SpeedBound<S>) for every limit at a point, first the speed bounds,
/// which do not depend on the squared path speed y. The order depends on the limits only; therefore the number of a
/// call identifies its limit.
/// @param trains  drive trains of the joints; null: there are no motors
template <class S, class Visit>
void visit_speed_bounds(const PathPoint<S>& p, const MotionLimits& limits, const DriveTrains* trains,
                        const Visit& visit) {
  const auto bound = [&](LimitKind kind, std::size_t joint, double limit, const S& rate_squared) {
    if (std::isfinite(limit)) visit(LimitOfMotion{kind, joint}, SpeedBound<S>{S(limit * limit) / rate_squared});
  };
  for (std::size_t i = 0; i < limits.joints.size(); ++i) {
    const JointLimits& joint = limits.joints[i];
    bound(LimitKind::joint_speed, i, joint.speed, p.q1[i] * p.q1[i]);
    if (joint.motor && trains) {
      const S rate = p.q1[i] * (*trains)[i].ratio;
      bound(LimitKind::motor_speed, i, joint.motor->speed, rate * rate);
    }
  }
  bound(LimitKind::tool_speed, 0, limits.tool_speed, S(p.tool11));
  // The component of the tool's acceleration normal to its velocity is proportional to the squared path speed y, so
  // that its limit is an upper bound of y.
  if (std::isfinite(limits.tool_acceleration)) {
    const double normal = p.tool11 > 0 ? std::fmax(p.tool22 - p.tool12 * p.tool12 / p.tool11, 0) : p.tool22;
    visit(LimitOfMotion{LimitKind::tool_acceleration}, SpeedBound<S>{S(limits.tool_acceleration / std::sqrt(normal))});
  }
}

/// Of two inequalities for the path acceleration u, one of which has to hold, selects the one to impose. If both bound
/// u from the same side, the weaker one is imposed; if together they exclude no u, neither (std::nullopt); if they
/// exclude an interval of u, the one with the steeper slope.
template <class S>
std::optional<LinearLimit<S>> weaker(const LinearLimit<S>& a, const LinearLimit<S>& b) {
  const auto slope = [](const LinearLimit<S>& x) { return value_of(x.slope); };
  const auto end = [&](const LinearLimit<S>& x) { return (value_of(x.limit) - value_of(x.offset)) / slope(x); };
  if (slope(a) == 0 || slope(b) == 0) {
    const LinearLimit<S>&flat = slope(a) == 0 ? a : b, &other = slope(a) == 0 ? b : a;
    if (value_of(flat.offset) <= value_of(flat.limit)) return std::nullopt;
    return other;
  }
  if (slope(a) > 0 && slope(b) > 0) return end(a) > end(b) ? a : b;
  if (slope(a) < 0 && slope(b) < 0) return end(a) < end(b) ? a : b;
  const LinearLimit<S>&upper = slope(a) > 0 ? a : b, &lower = slope(a) > 0 ? b : a;
  if (end(lower) <= end(upper)) return std::nullopt;
  return std::fabs(slope(a)) > std::fabs(slope(b)) ? a : b;
}

template <class S, class Visit>
void visit_linear_limits(const PathPoint<S>& p, const S& y, const MotionLimits& limits, const DriveTrains* trains,
                         const Visit& visit) {
  const S root = sqrt_or_zero(y);
  const auto both_sides = [&](const LimitOfMotion& which, const S& slope, const S& offset, double limit) {
    visit(which, LinearLimit<S>{slope, offset, S(limit), limit});
    visit(which, LinearLimit<S>{-slope, -offset, S(limit), limit});
  };
  for (std::size_t i = 0; i < limits.joints.size(); ++i) {
    const JointLimits& joint = limits.joints[i];
    if (std::isfinite(joint.acceleration))
      both_sides({LimitKind::joint_acceleration, i}, p.q1[i], p.q2[i] * y, joint.acceleration);
    if (p.A.size() == 0) continue;
    if (std::isfinite(joint.force)) both_sides({LimitKind::force, i}, p.A[i], p.B[i] * y + p.C[i], joint.force);
    if (!joint.motor || !trains) continue;
    const DriveTrain& train = (*trains)[i];
    const double J = train.reflected() / train.ratio;
    const S speed = p.q1[i] * root, slope = p.A[i] - p.q1[i] * train.reflected(),
            force = (p.B[i] - p.q2[i] * train.reflected()) * y + p.C[i] + train.friction(speed);
    const double mean = 0.5 * (1 / train.efficiency + train.efficiency),
                 half = 0.5 * (1 / train.efficiency - train.efficiency);
    const S n = train.direction(speed) * half, limit = joint.motor->torque_at(S(speed * train.ratio));
    const auto torque = [&](const S& factor, double sign) {  // the inequality sign * torque <= limit
      const S k = factor / train.ratio;
      return LinearLimit<S>{(p.q1[i] * J + slope * k) * sign, (p.q2[i] * y * J + force * k) * sign, limit,
                            joint.motor->peak_torque};
    };
    const LimitOfMotion which{LimitKind::peak_torque, i};
    const double convex = value_of(n) >= 0 ? 1 : -1;
    visit(which, torque(n + mean, convex));
    visit(which, torque(mean - n, convex));
    const auto other = weaker(torque(n + mean, -convex), torque(mean - n, -convex));
    visit(which, other.value_or(LinearLimit<S>{S(0.0), S(0.0), S(1.0), 1}));
  }
  if (std::isfinite(limits.tool_acceleration) && p.tool11 > 0) {
    // The limit a of the tool's acceleration X' u + X'' y restricts the path acceleration u to an interval about
    // -X'.X'' y / X'.X', which two linear inequalities describe.
    const double a = limits.tool_acceleration, tangential = std::sqrt(p.tool11);
    const double normal = std::fmax(p.tool22 - p.tool12 * p.tool12 / p.tool11, 0);
    const S half_width = sqrt_or_zero(S(a * a - y * y * normal));
    const S offset = y * (p.tool12 / tangential);
    const LimitOfMotion which{LimitKind::tool_acceleration};
    visit(which, LinearLimit<S>{S(tangential), offset, half_width, a});
    visit(which, LinearLimit<S>{S(-tangential), -offset, half_width, a});
  }
}

/// The interval of path accelerations that the linear limits allow, and the numbers of the limits that determine its
/// ends. Limits are numbered in the order of visit_linear_limits(); -1: no limit.
template <class S>
struct AccelerationInterval {
  S lower = S(-std::numeric_limits<double>::infinity()), upper = S(std::numeric_limits<double>::infinity());
  int at_lower = -1, at_upper = -1;
};
/// @param scale  factor by which all limits are multiplied
AccelerationInterval<double> acceleration_interval(const PathPoint<double>& p, double y, const MotionLimits& limits,
                                                   const DriveTrains* trains, double scale = 1);

/// The speed bound of the given number, in the order of visit_speed_bounds().
template <class S>
S speed_bound(const PathPoint<S>& p, const MotionLimits& limits, const DriveTrains* trains, int number) {
  S found(0.0);
  visit_speed_bounds(p, limits, trains, [&](const LimitOfMotion&, const SpeedBound<S>& bound) {
    if (number-- == 0) found = bound.bound;
  });
  return found;
}

/// The linear limit of the given number, in the order of visit_linear_limits().
template <class S>
LinearLimit<S> linear_limit(const PathPoint<S>& p, const S& y, const MotionLimits& limits, const DriveTrains* trains,
                            int number) {
  LinearLimit<S> found{};
  visit_linear_limits(p, y, limits, trains, [&](const LimitOfMotion&, const LinearLimit<S>& limit) {
    if (number-- == 0) found = limit;
  });
  return found;
}

/// The end of the interval of path accelerations that the linear limit of the given number determines.
template <class S>
S end_of_interval(const PathPoint<S>& p, const S& y, const MotionLimits& limits, const DriveTrains* trains,
                  int number) {
  const LinearLimit<S> found = linear_limit(p, y, limits, trains, number);
  return (found.limit - found.offset) / found.slope;
}

/// The maximum of the squared path speed y that the speed bounds allow (infinite if there are none), and the number of
/// the bound that determines it, in the order of visit_speed_bounds().
struct LargestSquare {
  double y = std::numeric_limits<double>::infinity();
  int number = -1;
};
LargestSquare largest_square(const PathPoint<double>& p, const MotionLimits& limits, const DriveTrains* trains);

/// The limit that is violated most for a given squared path speed y and path acceleration u. The violation is the
/// demand divided by the limit, minus 1; if it is negative, the limit is satisfied.
struct Violation {
  double value = -1;
  LimitOfMotion limit;
  bool is_speed = false;  ///< true: `number` counts speed bounds; false: it counts linear limits
  /// Number of the limit in the order of visit_speed_bounds() or visit_linear_limits(); -1: there are no limits.
  int number = -1;
};
Violation largest_violation(const PathPoint<double>& p, double y, double u, const MotionLimits& limits,
                            const DriveTrains* trains);

/// The largest factor in [0, `upper`] such that (factor y, factor u) satisfies the limits: the motion is then slowed
/// down by 1 / sqrt(factor). Negative if the limits cannot be satisfied even at rest.
double largest_factor(const PathPoint<double>& p, double y, double u, const MotionLimits& limits,
                      const DriveTrains* trains, double upper = 1);

}  // namespace pkm
