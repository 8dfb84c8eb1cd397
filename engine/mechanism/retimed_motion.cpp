// Constructs the fastest motion: the pauses and moves of the original motion, with new times.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/math/roots.hpp"
#include "engine/mechanism/fastest_motion.hpp"

namespace pkm {
namespace {

/// Relative reduction of the squared speeds after a violated limit, so that rounding errors do not violate it again.
constexpr double kInset = 1e-13;

/// A move or a pause of the retimed motion.
struct TimePiece {
  double begin, duration;  ///< begin of the move or pause in the retimed motion, and its duration [s]
  double original;         ///< begin of the move or pause in the original motion [s]
  bool moves = false;      ///< true: a move; false: a pause
  double end = 0;          ///< moves only: end of the move in the original motion [s]
  /// Factor by which the squared speeds of the profile, or (FastestLaw::own) of the original motion, are multiplied.
  double factor = 1;

  // The following members are set for moves with FastestLaw::optimal:
  std::shared_ptr<const GeometricPath> path = {};
  std::shared_ptr<const SpeedProfile> profile = {};
  /// Times and path lengths at the nodes of the speed profile, before `factor` is applied.
  std::vector<double> times = {}, lengths = {};
};

std::vector<double> times_of_nodes(const SpeedProfile& profile) {
  std::vector<double> times = {0};
  for (std::size_t i = 0; i + 1 < profile.squares.size(); ++i)
    times.push_back(times.back() +
                    2 * profile.steps[i] / (std::sqrt(profile.squares[i]) + std::sqrt(profile.squares[i + 1])));
  return times;
}

std::vector<TimePiece> retime(const MovesOfMotion& moves, const std::vector<FastestMove>& fastest,
                              const std::vector<double>& factors) {
  std::vector<TimePiece> pieces;
  double time = 0;
  const auto add_pause = [&](std::size_t k, double original) {
    if (moves.pause(k) > 0) pieces.push_back({time, moves.pause(k), original});
    time += moves.pause(k);
  };
  for (std::size_t k = 0; k < fastest.size(); ++k) {
    const MovesOfMotion::Move& move = moves.moves()[k];
    add_pause(k, k == 0 ? 0 : moves.moves()[k - 1].period.end);
    TimePiece piece{
        .begin = time,
        .duration = (fastest[k].profile ? fastest[k].profile->duration : move.period.end - move.period.begin) /
                    std::sqrt(factors[k]),
        .original = move.period.begin,
        .moves = true,
        .end = move.period.end,
        .factor = factors[k],
        .path = move.path,
        .profile = fastest[k].profile};
    if (piece.profile) {
      piece.times = times_of_nodes(*piece.profile);
      piece.lengths = {0};
      for (const double step : piece.profile->steps) piece.lengths.push_back(piece.lengths.back() + step);
    }
    time += piece.duration;
    pieces.push_back(std::move(piece));
  }
  add_pause(fastest.size(), moves.moves().back().period.end);
  return pieces;
}

MotionSample sample_of(const Motion& motion, const std::vector<TimePiece>& pieces, double time) {
  auto after = std::ranges::upper_bound(pieces, time, {}, &TimePiece::begin);
  const TimePiece& piece = after == pieces.begin() ? pieces.front() : *(after - 1);
  const double local = std::clamp(time - piece.begin, 0.0, piece.duration), root = std::sqrt(piece.factor);
  MotionSample found;
  if (!piece.profile) {
    found = motion.at(piece.moves ? time_inside({piece.original, piece.end}, piece.original + local * root)
                                  : piece.original + local);
    found.velocity = found.velocity * root;
    found.acceleration = found.acceleration * piece.factor;
  } else {
    const SpeedProfile& profile = *piece.profile;
    const double t = std::fmin(local * root, piece.times.back());
    const auto next = std::upper_bound(piece.times.begin(), piece.times.end(), t);
    const auto i = std::min(static_cast<std::size_t>(next - piece.times.begin()), profile.accelerations.size()) - 1;
    const double u = profile.accelerations[i], start = std::sqrt(profile.squares[i]), since = t - piece.times[i];
    const double speed = std::fmax(start + u * since, 0);
    const double s = piece.lengths[i] + (start + 0.5 * u * since) * since;
    found = piece.path->at(std::fmin(s, piece.path->length()));
    found.acceleration = (found.velocity * u + found.acceleration * (speed * speed)) * piece.factor;
    found.velocity = found.velocity * (speed * root);
  }
  found.time = time;
  return found;
}

/// Throws std::invalid_argument if inputs of the mechanism vary with time: their derivatives with respect to the path
/// would be undefined at stops.
void expect_no_inputs(const MovesOfMotion& moves) {
  for (const MovesOfMotion::Move& move : moves.moves())
    for (const MotionSample& at : move.samples)
      for (const InputSample& input : at.inputs)
        if (input.rate != 0 || input.acceleration != 0)
          throw std::invalid_argument("inputs of the motion that depend on the time have no fastest motion");
}

std::shared_ptr<const Motion> motion_of_pieces(const std::shared_ptr<const Motion>& original,
                                               std::vector<TimePiece> pieces) {
  const double duration = pieces.back().begin + pieces.back().duration;
  const auto write = [](TimeGraph&) -> std::vector<expression::Node> {
    throw std::logic_error("a fastest motion has no expression graph");
  };
  return std::make_shared<const Motion>(
      duration, [original, pieces = std::move(pieces)](double time) { return sample_of(*original, pieces, time); },
      write);
}

/// The largest factor, at most 1, by which the squared speeds of a move can be multiplied such that the limits hold at
/// both ends of every interval of its profile.
double factor_of_profile(const FastestMove& move, const DesignWithLimits& design, const MotionLimits& limits) {
  const SpeedProfile& profile = *move.profile;
  double factor = 1;
  for (std::size_t i = 0; i < profile.accelerations.size(); ++i)
    for (const std::size_t k : {i, i + 1})
      factor = std::fmin(factor, largest_factor(move.points[k], profile.squares[k], profile.accelerations[i], limits,
                                                design.mechanism.drive_trains(), factor));
  return factor;
}

/// The largest ratio of a motor's root-mean-square torque, over samples of the motion, to its continuous torque.
double thermal_load(const std::vector<PathPoint<double>>& points, const DesignWithLimits& design) {
  double largest = 0;
  for (std::size_t joint = 0; joint < design.limits.joints.size(); ++joint) {
    const std::optional<Motor>& motor = design.limits.joints[joint].motor;
    if (!motor) continue;
    const DriveTrain& train = (*design.mechanism.drive_trains())[joint];
    double squares = 0;
    for (const PathPoint<double>& p : points) {
      const double torque = motor_torque(p, joint, 1.0, 0.0, train);
      squares += torque * torque;
    }
    largest = std::fmax(largest, std::sqrt(squares / static_cast<double>(points.size())) / motor->continuous_torque);
  }
  return largest;
}

/// Slows the moves down until the limits and the continuous torques hold at equidistant times of the motion.
class SampledLimits {
 public:
  SampledLimits(const MovesOfMotion& moves, const ShortestTimes& times, const DesignWithLimits& design,
                std::size_t samples, std::vector<double> factors)
      : moves_(moves), times_(times), design_(design), samples_(samples), factors_(std::move(factors)) {}

  /// Slows the moves down until all limits hold at the sampled times, and returns the resulting motion.
  std::shared_ptr<const Motion> satisfy() {
    constexpr int kMaxSteps = 100;
    for (int step = 0; step < kMaxSteps; ++step)
      if (!slow_down_moves() && !slow_down_motion()) return motion();
    throw DesignError("the limits cannot be satisfied at all samples of the fastest motion");
  }

  /// Begin and end of each move in the resulting motion.
  std::vector<MovePeriod> periods() const {
    std::vector<MovePeriod> found;
    for (const TimePiece& piece : retime(moves_, times_.moves, factors_))
      if (piece.moves) found.push_back({piece.begin, piece.begin + piece.duration});
    return found;
  }

 private:
  std::shared_ptr<const Motion> motion() const { return motion(factors_); }
  std::shared_ptr<const Motion> motion(const std::vector<double>& factors) const {
    return motion_of_pieces(moves_.shared_motion(), retime(moves_, times_.moves, factors));
  }
  std::vector<PathPoint<double>> points(const std::vector<MotionSample>& at) const {
    std::vector<PathPoint<double>> found;
    path_points(design_.mechanism, design_.parameters, design_.mode, at, design_.wrench, found);
    if (found.size() < at.size()) throw DesignError("the fastest motion leaves the reach of the mechanism");
    return found;
  }
  /// Slows down each move in which a limit is violated.
  /// @return true if a limit was violated
  bool slow_down_moves() {
    const std::vector<MovePeriod> moves = periods();
    const std::vector<MotionSample> at = sample(*motion(), samples_);
    const std::vector<PathPoint<double>> found = points(at);
    const std::vector<double> before = factors_;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double factor = largest_factor(found[k], 1, 0, design_.limits, design_.mechanism.drive_trains());
      if (factor >= 1) continue;
      const auto after = std::ranges::upper_bound(moves, at[k].time, {}, &MovePeriod::begin);
      const auto move = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - moves.begin(), 1) - 1);
      factors_[move] = std::fmin(factors_[move], before[move] * std::fmax(factor, kSlowest) * (1 - kInset));
    }
    return factors_ != before;
  }
  /// Slows down all moves if a continuous torque is exceeded.
  /// @return true if one was exceeded
  bool slow_down_motion() {
    const auto scaled = [&](double factor) {
      std::vector<double> factors = factors_;
      for (double& each : factors) each *= factor;
      return factors;
    };
    const auto reserve = [&](double factor) {
      return 1 - thermal_load(points(sample(*motion(scaled(factor)), samples_)), design_);
    };
    const double at_once = reserve(1);
    if (at_once >= 0) return false;
    double low = 0.5, at_low = reserve(low);
    for (; at_low < 0 && low > kSlowest; at_low = reserve(low)) low *= 0.5;
    if (at_low < 0) throw DesignError("the continuous torque of a motor is exceeded at any speed of the motion");
    factors_ = scaled(refine_root(reserve, low, at_low, 1, at_once, 1e-12) * (1 - 1e-11));
    return true;
  }

  static constexpr double kSlowest = 1e-8;

  const MovesOfMotion& moves_;
  const ShortestTimes& times_;
  const DesignWithLimits& design_;
  std::size_t samples_;
  std::vector<double> factors_;  ///< for each move, the factor of its squared speeds
};

/// Appends to `active` the periods of a move during which a limit is active.
void add_active_periods(const MovesOfMotion::Move& move, const FastestMove& fastest, const DesignWithLimits& design,
                        const MovePeriod& period, double factor, std::vector<ActivePeriod>& active) {
  constexpr double kActive = 1e-6;  // a limit is active if the motion uses all of it, except for this relative amount
  const double root = std::sqrt(factor);
  if (!fastest.profile) {
    const double time = period.begin + (fastest.limiting.time - move.period.begin) / root;
    active.push_back({fastest.limit.limit, time, time, fastest.limiting.pose, fastest.limiting.pose});
    return;
  }
  const SpeedProfile& profile = *fastest.profile;
  const std::vector<double> times = times_of_nodes(profile);
  const std::size_t first = active.size();
  for (std::size_t i = 0; i < profile.accelerations.size(); ++i) {
    const auto violation_at = [&](std::size_t node) {
      return largest_violation(fastest.points[node], profile.squares[node], profile.accelerations[i], design.limits,
                               design.mechanism.drive_trains());
    };
    Violation here = violation_at(i);
    if (const Violation at_end = violation_at(i + 1); at_end.value > here.value) here = at_end;
    if (here.value < -kActive) continue;
    const double begin = period.begin + times[i] / root, end = period.begin + times[i + 1] / root;
    if (active.size() == first || !(active.back().limit == here.limit) || active.back().end < begin)
      active.push_back({here.limit, begin, end, move.samples[i].pose, move.samples[i + 1].pose});
    active.back().end = end;
    active.back().to = move.samples[i + 1].pose;
  }
}

/// The total duration of the moves if every other node is omitted, for an estimate of the discretisation error.
double duration_with_half_the_nodes(const MovesOfMotion& moves, const ShortestTimes& times,
                                    const DesignWithLimits& design, const MotionLimits& limits) {
  double duration = 0;
  for (std::size_t k = 0; k < times.moves.size(); ++k) {
    const MovesOfMotion::Move& move = moves.moves()[k];
    std::vector<PathPoint<double>> points;
    std::vector<double> steps;
    for (std::size_t i = 0; i < times.moves[k].points.size(); i += 2) {
      points.push_back(times.moves[k].points[i]);
      if (i > 0) steps.push_back(move.steps[i - 2] + move.steps[i - 1]);
    }
    duration += fastest_profile(points, std::move(steps), limits, design.mechanism.drive_trains(), [&](std::size_t i) {
                  return describe_time(move.samples[2 * i]);
                }).duration;
  }
  return duration;
}

/// Computes the profile of a move again, in a few iterations, with reduced limits at the points where the path
/// acceleration violates the limits at the other end of its interval.
SpeedProfile corrected_profile(const MovesOfMotion::Move& move, const FastestMove& found,
                               const DesignWithLimits& design, const MotionLimits& limits) {
  constexpr int kIterations = 8;
  constexpr double kNegligible = 1e-5;  // relative violations of a limit up to this are not corrected
  // The reduced limits exceed the load of holding the pose at rest by at least this fraction of the full limits.
  constexpr double kReserve = 0.02;
  const DriveTrains* const trains = design.mechanism.drive_trains();
  SpeedProfile profile = *found.profile;
  std::vector<double> scales(found.points.size(), 1.0);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    bool changed = false;
    for (std::size_t i = 0; i < profile.accelerations.size(); ++i) {
      const double violation =
          largest_violation(found.points[i + 1], profile.squares[i + 1], profile.accelerations[i], limits, trains)
              .value;
      if (violation < kNegligible) continue;
      const double to_hold = 1 + largest_violation(found.points[i], 0, 0, limits, trains).value;
      scales[i] = std::fmax(scales[i] / (1 + violation), std::fmin(to_hold + kReserve, scales[i]));
      changed = true;
    }
    if (!changed) break;
    profile = fastest_profile(
        found.points, move.steps, limits, trains, [&](std::size_t i) { return describe_time(move.samples[i]); },
        scales);
  }
  return profile;
}

}  // namespace

FastestMotion find_fastest_motion(const MovesOfMotion& moves, const DesignWithLimits& design, std::size_t samples) {
  expect_no_inputs(moves);
  ShortestTimes times = shortest_times(moves, design);
  const MotionLimits reduced = with_torques(design.limits, times.torque_factor);
  FastestMotion found;
  std::vector<double> factors;
  if (moves.law() == FastestLaw::optimal) {
    double before = 0, after = 0;
    const double halved = duration_with_half_the_nodes(moves, times, design, reduced);
    for (std::size_t k = 0; k < times.moves.size(); ++k) {
      FastestMove& move = times.moves[k];
      before += move.duration;
      move.profile = std::make_shared<const SpeedProfile>(corrected_profile(moves.moves()[k], move, design, reduced));
      move.duration = move.profile->duration;
      const double factor = factor_of_profile(move, design, reduced);
      after += move.duration / std::sqrt(factor);
      factors.push_back(times.thermal_factor * factor);
    }
    found.error = std::fmax(std::fabs(halved - before), std::fabs(after - before)) / std::sqrt(times.thermal_factor);
  } else {
    for (const FastestMove& move : times.moves) factors.push_back(times.thermal_factor * move.factor);
  }
  SampledLimits slowed(moves, times, design, samples, std::move(factors));
  found.motion = slowed.satisfy();
  found.moves = slowed.periods();
  found.duration = found.motion->duration();
  if (times.thermal_factor < 1 || times.torque_factor < 1) {
    const LimitOfMotion limit{LimitKind::continuous_torque, times.thermal_joint};
    found.active.push_back({limit, 0, found.duration, found.motion->at(0).pose, found.motion->at(found.duration).pose});
    return found;
  }
  for (std::size_t k = 0; k < times.moves.size(); ++k) {
    const MovePeriod& period = found.moves[k];
    const double root = times.moves[k].duration / (period.end - period.begin);
    add_active_periods(moves.moves()[k], times.moves[k], design, period,
                       times.moves[k].profile ? root * root : times.moves[k].factor, found.active);
  }
  return found;
}

}  // namespace pkm
