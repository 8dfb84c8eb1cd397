#include "engine/mechanism/speed_profile.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

using By = BindingLimit::By;
constexpr double kUnboundedSquare = 1e30;

/// The interval of path accelerations at point i that the limits allow and that lead to a squared speed in [0, next] at
/// point i + 1; and the limits that determine the ends of the interval.
struct AllowedAccelerations {
  double lower, upper;
  BindingLimit at_lower, at_upper;
  double width() const { return upper - lower; }
};

class ProfileSolver {
 public:
  ProfileSolver(std::span<const PathPoint<double>> points, std::span<const double> steps, const MotionLimits& limits,
                const DriveTrains* trains, std::span<const double> scales)
      : points_(points), steps_(steps), limits_(limits), trains_(trains), scales_(scales) {}

  AllowedAccelerations allowed(std::size_t i, double x, double next) const {
    const AccelerationInterval<double> u =
        acceleration_interval(points_[i], x, limits_, trains_, scales_.empty() ? 1 : scales_[i]);
    AllowedAccelerations found{u.lower, u.upper, {By::deceleration, u.at_lower}, {By::acceleration, u.at_upper}};
    const double to_next = (next - x) / (2 * steps_[i]), to_stop = -x / (2 * steps_[i]);
    if (to_next < found.upper) {
      found.upper = to_next;
      found.at_upper = {By::next};
    }
    if (to_stop > found.lower) {
      found.lower = to_stop;
      found.at_lower = {By::floor, u.at_lower};
    }
    return found;
  }

  /// The largest squared speed x at point i from which a squared speed in [0, next] can be reached at point i + 1;
  /// infinite if it is unbounded. It is bracketed by growing steps from `next`.
  double controllable(std::size_t i, double next, SpeedProfile::Backward& active) const {
    const auto width = [&](double x) { return allowed(i, x, next).width(); };
    const LargestSquare bound = largest_square(points_[i], limits_, trains_);
    if (std::isfinite(bound.y) && width(bound.y) >= 0) {
      active.upper = {By::speed, bound.number};
      return bound.y;
    }
    double low = std::fmin(next, bound.y), high = low, at_low = width(low), at_high = at_low;
    double grow = std::fmax(0.01 * low, 1e-9);
    if (at_low >= 0) {
      for (; at_high >= 0; grow *= 4) {
        low = high;
        at_low = at_high;
        high = std::fmin(low + grow, bound.y);
        at_high = width(high);
        if (high > kUnboundedSquare) return std::numeric_limits<double>::infinity();
      }
    } else {
      for (; at_low < 0 && low > 0; grow *= 4) {
        high = low;
        at_high = at_low;
        low = std::fmax(high - grow, 0);
        at_low = width(low);
      }
    }
    const double x = refine_root(width, low, at_low, high, at_high, 0);
    const AllowedAccelerations u = allowed(i, x, next);
    active = {u.at_upper, u.at_lower};
    return x;
  }

 private:
  std::span<const PathPoint<double>> points_;
  std::span<const double> steps_;
  const MotionLimits& limits_;
  const DriveTrains* trains_;
  std::span<const double> scales_;
};

/// Derivative, with respect to the squared speed x, of the path acceleration at which the linear limit with the index
/// `number` is attained.
double end_slope(const PathPoint<double>& point, double x, const MotionLimits& limits, const DriveTrains* trains,
                 int number) {
  return end_of_interval(constant_point<Dual<1>>(point), Dual<1>::variable(x, 0), limits, trains, number).v[0];
}

}  // namespace

SpeedProfile fastest_profile(std::span<const PathPoint<double>> points, std::vector<double> steps,
                             const MotionLimits& limits, const DriveTrains* trains,
                             const std::function<std::string(std::size_t)>& where, std::span<const double> scales) {
  PKM_EXPECTS(points.size() >= 3);
  const std::size_t n = points.size() - 1;
  for (std::size_t i = 0; i <= n; ++i) {
    const Violation at_rest = largest_violation(points[i], 0, 0, limits, trains);
    if (at_rest.value > 0)
      throw DesignError("the robot cannot hold its pose " + where(i) + ": the " + name_of(at_rest.limit.kind) +
                        " is exceeded at rest");
  }
  const ProfileSolver solver(points, steps, limits, trains, scales);
  SpeedProfile profile;
  profile.controllable.assign(n + 1, 0);
  profile.backward.resize(n);
  for (std::size_t i = n; i-- > 0;) {
    profile.controllable[i] = solver.controllable(i, profile.controllable[i + 1], profile.backward[i]);
    if (!std::isfinite(profile.controllable[i]))
      throw DesignError("no limit of acceleration, force or torque bounds the motion " + where(i));
  }
  profile.squares.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = profile.squares[i], next = profile.controllable[i + 1];
    const AllowedAccelerations u = solver.allowed(i, x, next);
    if (!std::isfinite(u.upper))
      throw DesignError("no limit of acceleration, force or torque bounds the motion " + where(i));
    profile.accelerations.push_back(u.upper);
    profile.forward.push_back(u.at_upper);
    profile.squares[i + 1] = u.at_upper.by == By::next ? next : std::clamp(x + 2 * steps[i] * u.upper, 0.0, next);
    const double sum = std::sqrt(x) + std::sqrt(profile.squares[i + 1]);
    if (!(sum > 0)) throw DesignError("the robot cannot move " + where(i) + " within the limits");
    profile.duration += 2 * steps[i] / sum;
  }
  profile.steps = std::move(steps);
  return profile;
}

ProfileWithDerivatives differentiate(const SpeedProfile& profile, std::span<const PathPoint<double>> points,
                                     std::span<const PathPoint<Dual4>> derivatives, const MotionLimits& limits,
                                     const DriveTrains* trains) {
  const std::size_t n = points.size() - 1;
  std::vector<Dual4> reachable(n + 1, Dual4(0.0));
  for (std::size_t i = n; i-- > 0;) {
    const BindingLimit& upper = profile.backward[i].upper;
    BindingLimit lower = profile.backward[i].lower;
    // If the squared speed at the next point has to be 0, both ends of the interval of path accelerations coincide for
    // all controllable squared speeds; the limit of the deceleration determines the largest of these.
    if (upper.by == By::next && lower.by == By::floor) lower.by = By::deceleration;
    const double x = profile.controllable[i], step2 = 2 * profile.steps[i];
    if (upper.by == By::speed) {
      reachable[i] = speed_bound(derivatives[i], limits, trains, upper.number);
      continue;
    }
    // The largest controllable squared speed is the x at which the upper and the lower end of the interval of path
    // accelerations coincide.
    const auto value = [&](const BindingLimit& bound) {
      if (bound.by == By::next) return (reachable[i + 1] - x) / step2;
      if (bound.by == By::floor) return Dual4(-x / step2);
      return end_of_interval(derivatives[i], Dual4(x), limits, trains, bound.number);
    };
    const auto slope = [&](const BindingLimit& bound) {
      if (bound.by == By::next || bound.by == By::floor) return -1 / step2;
      return end_slope(points[i], x, limits, trains, bound.number);
    };
    reachable[i] = Dual4(x) - (value(upper) - value(lower)) / (slope(upper) - slope(lower));
    reachable[i].a = x;
  }
  ProfileWithDerivatives found{.squares = {Dual4(0.0)}, .accelerations = {}};
  for (std::size_t i = 0; i < n; ++i) {
    const Dual4 x = found.squares[i];
    const double step2 = 2 * profile.steps[i];
    Dual4 next = reachable[i + 1];
    if (profile.forward[i].by != By::next) {
      const int number = profile.forward[i].number;
      Dual4 u = end_of_interval(derivatives[i], Dual4(x.a), limits, trains, number);
      if (x.a > 0) u += Dual4(0.0, x.v * end_slope(points[i], x.a, limits, trains, number));
      next = x + u * step2;
    }
    next.a = profile.squares[i + 1];
    Dual4 u = (next - x) / step2;
    u.a = profile.accelerations[i];
    found.squares.push_back(next);
    found.accelerations.push_back(u);
  }
  return found;
}

}  // namespace pkm
