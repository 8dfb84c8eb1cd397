#include "engine/mechanism/fastest_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/minimum.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

bool is_finite_sample(const MotionSample& at) {
  for (const AxisVector<double>* values : {&at.pose, &at.velocity, &at.acceleration})
    if (!std::ranges::all_of(*values, [](double x) { return std::isfinite(x); })) return false;
  return true;
}

/// Throws std::invalid_argument if the path of a move has a corner: its tangent changes between two samples by more
/// than its curvature there explains.
void refuse_corners(const MovesOfMotion::Move& move) {
  constexpr double kCorner = 0.2;  // change of the tangent between two samples that is always allowed [rad]
  // Factor by which the change of the tangent may exceed the change that the curvature at the samples predicts.
  constexpr double kExplained = 4;
  for (std::size_t i = 1; i < move.samples.size(); ++i) {
    const MotionSample &a = move.samples[i - 1], &b = move.samples[i];
    const AxisVector<double> change = b.velocity - a.velocity;
    const double curvature =
        std::sqrt(std::fmax(dot(a.acceleration, a.acceleration), dot(b.acceleration, b.acceleration)));
    if (std::sqrt(dot(change, change)) > kCorner + kExplained * curvature * move.steps[i - 1])
      throw std::invalid_argument("the path of the motion has a corner " + describe_time(b) +
                                  " at which the motion does not stop");
  }
}

/// Pose, velocity and acceleration of the motion, with its own time law, at a time.
MotionSample sample_at(const Motion& motion, double time) {
  MotionSample found = motion.at(time);
  found.time = time;
  return found;
}

/// Computes the points of a move. Throws DesignError at the first sample that cannot be assembled or is singular.
std::vector<PathPoint<double>> points_at(const DesignWithLimits& design, std::span<const MotionSample> samples) {
  std::vector<PathPoint<double>> points;
  const std::size_t count =
      path_points(design.mechanism, design.parameters, design.mode, samples, design.wrench, points);
  if (count == samples.size()) return points;
  const PoseReport report =
      design.mechanism.inspect(design.parameters, samples[count].pose, design.mode, no_limits(design.mechanism.info()));
  if (report.assembles) throw DesignError("the motion passes through a singularity " + describe_time(samples[count]));
  throw DesignError("the motion leaves the reach of the mechanism " + describe_time(samples[count]) +
                    (report.reason.empty() ? "" : " (" + report.reason + ")"));
}

/// The largest factor, at most `upper`, by which the limits allow the squared speeds at a sample of the motion to be
/// multiplied.
double factor_at(const DesignWithLimits& design, const MotionSample& sample, double upper) {
  return largest_factor(points_at(design, {&sample, 1})[0], 1, 0, design.limits, design.mechanism.drive_trains(),
                        upper);
}

/// Computes the largest factor by which the squared speeds of a move with its own time law can be multiplied. Local
/// minima of the factor over the time are located by golden-section search.
void scale_own_law(const MovesOfMotion& moves, const MovesOfMotion::Move& move, const DesignWithLimits& design,
                   FastestMove& found) {
  // A local minimum between samples is searched for only near samples at which the factor of the squared speeds is at
  // most kCandidates times the smallest one of all samples.
  constexpr double kCandidates = 1.05;
  constexpr double kUnbounded = 1e30;
  // Final width of the bracket of a local minimum over the time, relative to the width of the initial bracket.
  constexpr double kBracketOfPeak = 1e-9;
  const DriveTrains* const trains = design.mechanism.drive_trains();
  const auto violation = [&](const PathPoint<double>& p, double factor) {
    return largest_violation(p, factor, 0, design.limits, trains);
  };
  double best = 1;
  const auto all_satisfied = [&](double factor) {
    return std::ranges::all_of(found.points, [&](const auto& p) { return violation(p, factor).value <= 0; });
  };
  for (; all_satisfied(best); best *= 4)
    if (best > kUnbounded) throw DesignError("no limit bounds the motion " + describe_time(move.samples[0]));
  found.limiting = move.samples[0];
  const auto improve = [&](double factor, const MotionSample& at) {
    if (factor < 0)
      throw DesignError("the robot cannot hold its pose " + describe_time(at) + ": the " +
                        name_of(violation(points_at(design, {&at, 1})[0], 0).limit.kind) + " is exceeded at rest");
    if (factor >= best) return;
    best = factor;
    found.limiting = at;
  };
  for (std::size_t k = 0; k < move.samples.size(); ++k)
    improve(largest_factor(found.points[k], 1, 0, design.limits, trains, best), move.samples[k]);
  const double upper = kCandidates * best;
  std::vector<double> factors;
  for (const PathPoint<double>& p : found.points)
    factors.push_back(largest_factor(p, 1, 0, design.limits, trains, upper));
  for (std::size_t k = 1; k + 1 < factors.size(); ++k) {
    if (!(factors[k] < upper && factors[k] <= factors[k - 1] && factors[k] < factors[k + 1])) continue;
    const double low = move.samples[k - 1].time, high = move.samples[k + 1].time;
    const auto factor = [&](double time) { return factor_at(design, sample_at(moves.motion(), time), upper); };
    const double time = golden_section(factor, low, high, kBracketOfPeak * (high - low));
    improve(factor(time), sample_at(moves.motion(), time));
  }
  found.factor = best;
  found.limit = violation(points_at(design, {&found.limiting, 1})[0], best);
  found.duration = (move.period.end - move.period.begin) / std::sqrt(best);
}

/// For each interval of a move, the squared path speeds at both of its ends, and the constant path acceleration in it.
template <class S>
struct MoveStates {
  const std::vector<PathPoint<S>>* points;
  std::vector<S> squares, accelerations;
  const std::vector<double>* steps;
};

MoveStates<double> states_of(const MovesOfMotion::Move& move, const FastestMove& found) {
  if (found.profile) return {&found.points, found.profile->squares, found.profile->accelerations, &move.steps};
  const std::size_t n = found.points.size();
  return {&found.points, std::vector<double>(n, found.factor), std::vector<double>(n - 1, 0.0), &move.steps};
}

/// The mean square of a motor's torque over the motion, by the trapezoidal rule, if all squared speeds of the moves are
/// multiplied by a factor.
template <class S>
S mean_square_torque(const MovesOfMotion& moves, const std::vector<MoveStates<S>>& states, std::size_t joint,
                     const DriveTrain& train, const S& factor) {
  S integral(0.0), time(0.0);
  const auto hold = [&](const PathPoint<S>& p, double duration) {
    const S torque = motor_torque(p, joint, S(0.0), S(0.0), train);
    integral += torque * torque * duration;
    time += duration;
  };
  const S root = sqrt(factor);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const MoveStates<S>& move = states[k];
    const std::vector<PathPoint<S>>& points = *move.points;
    hold(points.front(), moves.pause(k));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const S x = move.squares[i], next = move.squares[i + 1], u = move.accelerations[i] * factor;
      const S duration = (2 * (*move.steps)[i]) / ((sqrt_or_zero(x) + sqrt_or_zero(next)) * root);
      const S a = motor_torque(points[i], joint, S(x * factor), u, train),
              b = motor_torque(points[i + 1], joint, S(next * factor), u, train);
      integral += (a * a + b * b) * duration * 0.5;
      time += duration;
    }
  }
  hold(states.back().points->back(), moves.pause(states.size()));
  return integral / time;
}

/// The minimum over the joints of the squared continuous torque minus the mean square of the torque; infinite if there
/// are no motors. Stores the joint of the minimum in `found`.
double thermal_reserve(const MovesOfMotion& moves, const DesignWithLimits& design, ShortestTimes& found) {
  std::vector<MoveStates<double>> states;
  for (std::size_t k = 0; k < found.moves.size(); ++k) states.push_back(states_of(moves.moves()[k], found.moves[k]));
  double minimum = std::numeric_limits<double>::infinity();
  for (std::size_t joint = 0; joint < design.limits.joints.size(); ++joint) {
    const std::optional<Motor>& motor = design.limits.joints[joint].motor;
    if (!motor) continue;
    const double reserve = motor->continuous_torque * motor->continuous_torque -
                           mean_square_torque(moves, states, joint, (*design.mechanism.drive_trains())[joint], 1.0);
    if (reserve >= minimum) continue;
    minimum = reserve;
    found.thermal_joint = joint;
  }
  return minimum;
}

/// Finds the factor, at most 1, of the squared speeds of all moves with which no motor's root-mean-square torque
/// exceeds its continuous torque.
void limit_continuous_torque(const MovesOfMotion& moves, const DesignWithLimits& design, ShortestTimes& found) {
  constexpr double kSlowest = 1e-8;
  // Violations of a continuous torque up to this, relative to the squared torque, are within the accuracy of
  // reduce_torques() and are ignored.
  constexpr double kRounding = 1e-9;
  std::vector<MoveStates<double>> states;
  for (std::size_t k = 0; k < found.moves.size(); ++k) states.push_back(states_of(moves.moves()[k], found.moves[k]));
  for (std::size_t joint = 0; joint < design.limits.joints.size(); ++joint) {
    const std::optional<Motor>& motor = design.limits.joints[joint].motor;
    if (!motor) continue;
    const double square = motor->continuous_torque * motor->continuous_torque;
    const auto reserve = [&](double factor) {
      return square - mean_square_torque(moves, states, joint, (*design.mechanism.drive_trains())[joint], factor);
    };
    const double high = found.thermal_factor, at_high = reserve(high);
    if (at_high >= -kRounding * square) continue;
    double low = high / 4;
    while (low > kSlowest && reserve(low) < 0) low /= 4;
    if (low <= kSlowest)
      throw DesignError("the continuous torque of the motor of joint " + design.mechanism.info().joints[joint].name +
                        " is exceeded at any speed of the motion");
    found.thermal_factor = refine_root(reserve, low, reserve(low), high, at_high, 0);
    found.thermal_joint = joint;
  }
}

/// Computes the time-optimal speed profiles of all moves.
void find_profiles(const MovesOfMotion& moves, const DesignWithLimits& design, const MotionLimits& limits,
                   ShortestTimes& found) {
  for (std::size_t k = 0; k < found.moves.size(); ++k) {
    const MovesOfMotion::Move& move = moves.moves()[k];
    FastestMove& result = found.moves[k];
    result.profile = std::make_shared<const SpeedProfile>(
        fastest_profile(result.points, move.steps, limits, design.mechanism.drive_trains(),
                        [&](std::size_t i) { return describe_time(move.samples[i]); }));
    result.duration = result.profile->duration;
  }
}

/// Reduces the peak torques of all motors by one factor until the root-mean-square torques are at most the continuous
/// ones, or until a pose can no longer be held.
void reduce_torques(const MovesOfMotion& moves, const DesignWithLimits& design, ShortestTimes& found) {
  constexpr double kReduction = 0.8;
  constexpr double kWidth = 1e-12;
  const auto reserve = [&](double factor) {
    find_profiles(moves, design, with_torques(design.limits, factor), found);
    found.torque_factor = factor;
    return thermal_reserve(moves, design, found);
  };
  double high = 1, at_high = thermal_reserve(moves, design, found);
  if (at_high >= 0) return;
  try {
    for (;;) {
      const double low = kReduction * high, at_low = reserve(low);
      if (at_low >= 0) {
        reserve(refine_root(reserve, low, at_low, high, at_high, kWidth));
        return;
      }
      high = low;
      at_high = at_low;
    }
  } catch (const DesignError&) {  // the torques are not sufficient to hold a pose
    reserve(high);
  }
}

/// The continuous torque determines a factor by which the peak torques or the speeds are multiplied. Adds the
/// contribution of this factor to the derivatives of the moves' total duration, by implicit differentiation of the mean
/// square torque. The derivative of the mean square torque with respect to the factor is a central difference.
/// @param duration  total duration of the moves without pauses, before they are slowed down, with derivatives at a
/// constant factor
Dual4 differentiate_thermal_factor(const MovesOfMotion& moves, const ShortestTimes& found,
                                   const DesignWithLimits& design, const std::vector<MoveStates<Dual4>>& states,
                                   const Dual4& duration) {
  constexpr double kStep = 1e-5;  // step of the central difference, relative to the factor
  const DriveTrain& train = (*design.mechanism.drive_trains())[found.thermal_joint];
  const Dual4 square = mean_square_torque(moves, states, found.thermal_joint, train, Dual4(found.thermal_factor));
  struct Shifted {
    double square, duration;
  };
  const auto at = [&](double change) {
    ShortestTimes shifted = found;
    double factor = 1;
    if (found.thermal_factor < 1)
      factor = change * found.thermal_factor;
    else
      find_profiles(moves, design, with_torques(design.limits, change * found.torque_factor), shifted);
    std::vector<MoveStates<double>> values;
    double sum = 0;
    for (std::size_t k = 0; k < shifted.moves.size(); ++k) {
      values.push_back(states_of(moves.moves()[k], shifted.moves[k]));
      sum += shifted.moves[k].duration / std::sqrt(factor);
    }
    return Shifted{mean_square_torque(moves, values, found.thermal_joint, train, factor), sum};
  };
  const Shifted more = at(1 + kStep), less = at(1 - kStep);
  const Dual4 slowed = duration / std::sqrt(found.thermal_factor);
  return Dual4(slowed.a, slowed.v + square.v * (-(more.duration - less.duration) / (more.square - less.square)));
}

double total_duration(const MovesOfMotion& moves, const ShortestTimes& found) {
  double duration = moves.pause(found.moves.size());
  for (std::size_t k = 0; k < found.moves.size(); ++k)
    duration += moves.pause(k) + found.moves[k].duration / std::sqrt(found.thermal_factor);
  return duration;
}

}  // namespace

double time_inside(const MovePeriod& move, double time) {
  constexpr double kMargin = 1e-9;
  const double margin = kMargin * (move.end - move.begin);
  return std::clamp(time, move.begin + margin, move.end - margin);
}

std::string describe_time(const MotionSample& sample) {
  return "at t = " + with_unit(sample.time, "s") + " of the motion";
}

MovesOfMotion::MovesOfMotion(std::shared_ptr<const Motion> motion, FastestLaw law, std::size_t nodes)
    : motion_(std::move(motion)), law_(law) {
  PKM_EXPECTS(nodes >= 4 && nodes % 2 == 0);
  for (const MovePeriod& period : find_moves(*motion_)) {
    Move move{.period = period, .path = {}, .samples = {}};
    if (law == FastestLaw::optimal) {
      move.path = std::make_shared<const GeometricPath>(motion_, period);
      if (!std::isfinite(move.path->length())) throw std::invalid_argument("the motion is not finite");
    }
    const double duration = period.end - period.begin;
    double last = 0;
    for (std::size_t i = 0; i <= nodes; ++i) {
      const double s =
          move.path ? move.path->node(i, nodes) : duration * (static_cast<double>(i) / static_cast<double>(nodes));
      if (i > 0) move.steps.push_back(s - last);
      last = s;
      move.samples.push_back(move.path ? move.path->at(s) : sample_at(*motion_, time_inside(period, period.begin + s)));
      if (!is_finite_sample(move.samples.back()))
        throw std::invalid_argument("the pose, velocity or acceleration of the motion is not finite " +
                                    describe_time(move.samples.back()));
    }
    if (move.path) refuse_corners(move);
    moves_.push_back(std::move(move));
  }
  if (moves_.empty()) throw std::invalid_argument("the motion does not move");
}

double MovesOfMotion::pause(std::size_t k) const {
  const double from = k == 0 ? 0 : moves_[k - 1].period.end;
  return std::fmax((k == moves_.size() ? motion_->duration() : moves_[k].period.begin) - from, 0);
}

MotionLimits with_torques(const MotionLimits& limits, double factor) {
  MotionLimits reduced = limits;
  for (JointLimits& joint : reduced.joints) {
    if (!joint.motor) continue;
    joint.motor->peak_torque *= factor;
    for (TorqueAtSpeed& point : joint.motor->curve) point.torque *= factor;
  }
  return reduced;
}

ShortestTimes shortest_times(const MovesOfMotion& moves, const DesignWithLimits& design) {
  if (const Unsupported reason = why_no_limits(design.mechanism, design.limits)) throw DesignError(*reason);
  ShortestTimes found;
  for (const MovesOfMotion::Move& move : moves.moves()) {
    FastestMove& result = found.moves.emplace_back(FastestMove{.points = points_at(design, move.samples)});
    if (moves.law() == FastestLaw::own) scale_own_law(moves, move, design, result);
  }
  if (moves.law() == FastestLaw::optimal) {
    find_profiles(moves, design, design.limits, found);
    reduce_torques(moves, design, found);
  }
  limit_continuous_torque(moves, design, found);
  found.duration = total_duration(moves, found);
  return found;
}

double energy_of(const MovesOfMotion& moves, const ShortestTimes& found, const DesignWithLimits& design,
                 bool recuperates) {
  const DriveTrains* const trains = design.mechanism.drive_trains();
  const auto power = [&](const PathPoint<double>& p, double y, double u) {
    double sum = 0;
    for (std::size_t joint = 0; joint < p.q1.size(); ++joint) {
      const double speed = p.q1[joint] * std::sqrt(y);
      const double own = trains ? motor_torque(p, joint, y, u, (*trains)[joint]) * speed * (*trains)[joint].ratio
                                : (p.A[joint] * u + p.B[joint] * y + p.C[joint]) * speed;
      if (recuperates || own > 0) sum += own;
    }
    return sum;
  };
  double energy = 0;
  for (std::size_t k = 0; k < found.moves.size(); ++k) {
    const MoveStates<double> move = states_of(moves.moves()[k], found.moves[k]);
    for (std::size_t i = 0; i < move.accelerations.size(); ++i) {
      const double x = move.squares[i] * found.thermal_factor, next = move.squares[i + 1] * found.thermal_factor,
                   u = move.accelerations[i] * found.thermal_factor;
      const double duration = 2 * (*move.steps)[i] / (std::sqrt(x) + std::sqrt(next));
      energy += 0.5 * duration * (power((*move.points)[i], x, u) + power((*move.points)[i + 1], next, u));
    }
  }
  return energy;
}

Dual4 duration_with_derivatives(const MovesOfMotion& moves, const ShortestTimes& found, const DesignWithLimits& design,
                                std::span<const Dual4> parameters) {
  const DriveTrains* const trains = design.mechanism.drive_trains();
  const MotionLimits limits = with_torques(design.limits, found.torque_factor);
  std::vector<std::vector<PathPoint<Dual4>>> points(found.moves.size());
  std::vector<MoveStates<Dual4>> states;
  Dual4 duration(0.0);
  for (std::size_t k = 0; k < found.moves.size(); ++k) {
    const MovesOfMotion::Move& move = moves.moves()[k];
    const FastestMove& result = found.moves[k];
    path_points<Dual4>(design.mechanism, parameters, design.mode, move.samples, design.wrench, points[k]);
    if (points[k].size() != result.points.size()) return Dual4(std::numeric_limits<double>::quiet_NaN());
    MoveStates<Dual4>& state = states.emplace_back(MoveStates<Dual4>{&points[k], {}, {}, &move.steps});
    if (result.profile) {
      auto profile = differentiate(*result.profile, result.points, points[k], limits, trains);
      state.squares = std::move(profile.squares);
      state.accelerations = std::move(profile.accelerations);
    } else {
      // The limit that is active at the sample `limiting` determines the factor of the squared speeds: differentiate
      // this limit implicitly, at the fixed time of this sample.
      std::vector<PathPoint<Dual4>> at;
      path_points<Dual4>(design.mechanism, parameters, design.mode, {&result.limiting, 1}, design.wrench, at);
      const PathPoint<Dual<1>> constant = constant_point<Dual<1>>(points_at(design, {&result.limiting, 1})[0]);
      Dual4 factor(result.factor);
      if (result.limit.is_speed) {
        factor = speed_bound(at[0], design.limits, trains, result.limit.number);
      } else {
        const Dual4 value =
            linear_limit(at[0], factor, design.limits, trains, result.limit.number).violation(Dual4(0.0));
        const Dual<1> along =
            linear_limit(constant, Dual<1>::variable(result.factor, 0), design.limits, trains, result.limit.number)
                .violation(Dual<1>(0.0));
        factor = factor - value / along.v[0];
      }
      factor.a = result.factor;
      state.squares.assign(result.points.size(), factor);
      state.accelerations.assign(result.points.size() - 1, Dual4(0.0));
    }
    for (std::size_t i = 0; i + 1 < state.squares.size(); ++i)
      duration += (2 * move.steps[i]) / (sqrt_or_zero(state.squares[i]) + sqrt_or_zero(state.squares[i + 1]));
  }
  if (found.torque_factor < 1 || found.thermal_factor < 1)
    duration = differentiate_thermal_factor(moves, found, design, states, duration);
  for (std::size_t k = 0; k <= found.moves.size(); ++k) duration += moves.pause(k);
  return duration;
}

}  // namespace pkm
