// Time-optimal path parametrisation by reachability analysis (TOPP-RA): the fastest motion along a given path, from
// rest to rest, within limits that are evaluated at points of the path.
//
// With x_i = sdot^2 and u_i = sddot at point i, x_(i+1) = x_i + 2 D_i u_i. Backwards from the end, the set of squared
// speeds [0, c_i] is computed from which the end can be reached (the controllable set); then, forwards from the start,
// the largest u_i that stays in these sets. Zero-inertia points need no special treatment. The robot must be able to
// hold every pose at rest, so that the controllable sets begin at 0.
//
// Unlike the original, which solves linear programs in (u, x), the interval of u is computed in closed form for each x,
// and c_i by root finding in x: so friction and the curve of the torque over the speed need not be linear in x.
//
// Reference: H. Pham, Q.-C. Pham, "A new approach to time-optimal path parameterization based on reachability
// analysis", IEEE Transactions on Robotics 34 (3), 2018, 645-659.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/path_limits.hpp"

namespace pkm {

/// The limit that determines a value of the speed profile.
struct BindingLimit {
  enum class By { speed, acceleration, deceleration, next, floor } by = By::floor;
  /// Number of the limit in the order of visit_speed_bounds() or visit_linear_limits(). With By::floor, the minimum of
  /// the path acceleration is the one that stops the motion at the next point; `number` is then the linear limit that
  /// would allow an even smaller path acceleration.
  int number = -1;
};

struct SpeedProfile {
  std::vector<double> steps;  ///< distances of consecutive points in the path parameter
  /// Squared path speed x_i at each point [1/s^2 times the squared unit of the path]; 0 at the first and the last
  /// point.
  std::vector<double> squares;
  std::vector<double> accelerations;  ///< constant path acceleration u_i in each interval between consecutive points
  double duration = 0;                ///< duration of the motion [s]
  /// For each point, the largest squared speed c_i from which rest at the end can be reached.
  std::vector<double> controllable;
  /// The limits that determine the controllable squared speed c_i of a point: those at the upper and at the lower end
  /// of the interval of path accelerations, or a speed bound in `upper`; `lower` is then unused.
  struct Backward {
    BindingLimit upper, lower;
  };
  std::vector<Backward> backward;  ///< limits that determine the controllable squared speed of each point but the last
  std::vector<BindingLimit> forward;  ///< for each interval, the limit that determines its path acceleration
};

/// Computes the fastest profile from rest to rest. Throws DesignError if a pose cannot be held at rest or no limit
/// bounds the motion.
/// @param points  N + 1 >= 3 points of the path
/// @param steps   distances of consecutive points in the path parameter
/// @param trains  drive trains of the joints; null: there are no motors
/// @param where   where(i): description of point i for messages
/// @param scales  factors of the limits of acceleration, force and torque at each point; empty: 1
SpeedProfile fastest_profile(std::span<const PathPoint<double>> points, std::vector<double> steps,
                             const MotionLimits& limits, const DriveTrains* trains,
                             const std::function<std::string(std::size_t)>& where, std::span<const double> scales = {});

/// The squared speeds and the accelerations of a profile with their derivatives, by implicit differentiation of the
/// active limits: the derivatives of the optimum wherever the active limits do not change.
/// @param points       the points of the profile
/// @param derivatives  the same points, with derivatives
struct ProfileWithDerivatives {
  std::vector<Dual4> squares, accelerations;
};
ProfileWithDerivatives differentiate(const SpeedProfile& profile, std::span<const PathPoint<double>> points,
                                     std::span<const PathPoint<Dual4>> derivatives, const MotionLimits& limits,
                                     const DriveTrains* trains);

}  // namespace pkm
