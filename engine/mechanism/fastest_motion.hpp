// The fastest motion along the path of a given motion, within limits of the joints, motors and the tool.
//
// A motion is a sequence of moves between stops (find_moves()). Each move is made as fast as possible by itself;
// pauses keep their durations. With the law `optimal`, only the path of the motion is kept, and the speed along it is
// that of the time-optimal path parametrisation (speed_profile.hpp). With the law `own`, the motion keeps its time law,
// and the time of each move is scaled by one factor.
//
// If the continuous torque of a motor (the root mean square over the motion, with its pauses) limits the motion, the
// peak torques of all motors are reduced by one factor (`optimal`), or all moves are slowed down by one factor (`own`).
// The first is not the optimum: for a constant inertia, the shortest time for a given root mean square is 7 % shorter.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/mechanism/speed_profile.hpp"
#include "engine/motion/path.hpp"

namespace pkm {

enum class FastestLaw { optimal, own };

/// Moves a time into the interior of a move, at least 1e-9 of the move's duration away from both ends: at an end, the
/// acceleration could be that of the next move or pause.
double time_inside(const MovePeriod& move, double time);

/// The moves of a motion, prepared for many designs. Immutable and thread-safe.
class MovesOfMotion {
 public:
  /// Throws std::invalid_argument if the motion has no moves, values that are not finite, or a corner at which it does
  /// not stop.
  /// @param nodes  number of intervals into which the path of each move (with FastestLaw::own, its duration) is
  /// divided; even, >= 4
  MovesOfMotion(std::shared_ptr<const Motion> motion, FastestLaw law, std::size_t nodes);

  struct Move {
    MovePeriod period;
    std::shared_ptr<const GeometricPath> path;  ///< path of the move, with FastestLaw::optimal; otherwise null
    /// Samples of the move at the ends of the intervals into which it is divided.
    std::vector<MotionSample> samples;
    /// For consecutive samples, the differences of the path parameter or, with FastestLaw::own, of the time [s].
    std::vector<double> steps;
  };
  const std::vector<Move>& moves() const { return moves_; }
  const Motion& motion() const { return *motion_; }
  const std::shared_ptr<const Motion>& shared_motion() const { return motion_; }
  FastestLaw law() const { return law_; }
  /// Duration of the pause before move k [s]; for k = moves().size(), of the pause after the last move.
  double pause(std::size_t k) const;

 private:
  std::shared_ptr<const Motion> motion_;
  FastestLaw law_;
  std::vector<Move> moves_;
};

/// A mechanism, one of its designs in one working mode, and the limits and the load of its motion.
struct DesignWithLimits {
  const Mechanism& mechanism;
  std::span<const double> parameters;
  const std::string& mode;
  const MotionLimits& limits;
  const Wrench<double>& wrench;
};

/// The fastest execution of one move.
struct FastestMove {
  double duration = 0;                    ///< duration of the move [s]
  std::vector<PathPoint<double>> points;  ///< points of the path at the samples of the move
  /// Time-optimal speed profile, with FastestLaw::optimal; otherwise null.
  std::shared_ptr<const SpeedProfile> profile = {};
  /// With FastestLaw::own: square of the ratio of the speeds of the fastest motion to those of the given motion.
  double factor = 1;
  MotionSample limiting = {};  ///< with FastestLaw::own: the sample of the motion that limits `factor`
  Violation limit = {};        ///< with FastestLaw::own: the limit that is active at `limiting`
};

/// The fastest execution of all moves, and the factors that the continuous torques of the motors impose.
struct ShortestTimes {
  std::vector<FastestMove> moves;
  /// Factors in (0, 1] by which the root-mean-square torque of every motor becomes at most its continuous torque:
  /// `torque_factor` multiplies the peak torques of all motors (FastestLaw::optimal only), `thermal_factor` the squared
  /// speeds of all moves. 1: the continuous torques do not limit the motion.
  double torque_factor = 1, thermal_factor = 1;
  std::size_t thermal_joint = 0;  ///< index of the joint whose motor determines torque_factor and thermal_factor
  double duration = 0;            ///< duration of the motion, including its pauses [s]
};

/// Computes the shortest durations. Throws DesignError if the mechanism cannot be assembled along the path, is singular
/// there, or cannot perform the motion at any speed.
ShortestTimes shortest_times(const MovesOfMotion& moves, const DesignWithLimits& design);

/// The duration of the motion [s] with its derivatives with respect to the variables of the design.
/// @param found  result of shortest_times() for the design
Dual4 duration_with_derivatives(const MovesOfMotion& moves, const ShortestTimes& found, const DesignWithLimits& design,
                                std::span<const Dual4> parameters);

/// Energy of the drives over the fastest motion [J], by the trapezoidal rule over the nodes of all moves. It is the
/// energy of the motors if there are drive trains, otherwise that of the joints. The mechanism must have dynamics.
/// @param found        result of shortest_times() for the design
/// @param recuperates  true: drives that brake return their energy; false: it is lost
double energy_of(const MovesOfMotion& moves, const ShortestTimes& found, const DesignWithLimits& design,
                 bool recuperates);

/// Returns the limits with the peak torques and torque curves of all motors multiplied by a factor.
MotionLimits with_torques(const MotionLimits& limits, double factor);

/// Text for messages, for example "at t = 0.5 s of the motion".
std::string describe_time(const MotionSample& sample);

/// A period of the fastest motion during which a limit is active.
struct ActivePeriod {
  LimitOfMotion limit;
  double begin = 0, end = 0;  ///< first and last instant of the period [s]
  Pose<double> from, to;      ///< poses at `begin` and at `end`
};

struct FastestMotion {
  double duration = 0;  ///< duration of the motion, including its pauses [s]
  /// Estimate of the discretisation error of the duration [s]: the larger of its change if half of the nodes are
  /// omitted and its change if the speeds are reduced until the limits hold at both ends of every interval; 0 with
  /// FastestLaw::own.
  double error = 0;
  std::shared_ptr<const Motion> motion;  ///< the fastest motion
  std::vector<MovePeriod> moves;         ///< begin and end of each move of the fastest motion
  std::vector<ActivePeriod> active;
};

/// Computes the fastest motion. Its limits are satisfied, to rounding, at all nodes and at `samples` equidistant times;
/// a move that exceeds a limit at one of these times is slowed down.
FastestMotion find_fastest_motion(const MovesOfMotion& moves, const DesignWithLimits& design, std::size_t samples);

}  // namespace pkm
