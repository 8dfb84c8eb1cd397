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

/// Time of a sample within a move: at least 1e-9 of its duration from both ends, beyond which the acceleration can be
/// that of the next move or pause.
double time_inside(const MovePeriod& move, double time);

/// The moves of a motion, prepared for many designs. Immutable and thread-safe.
class MovesOfMotion {
 public:
  /// Throws std::invalid_argument if the motion has no moves, values that are not finite, or a corner without a stop.
  /// @param nodes  intervals of the path of a move, or of its time with FastestLaw::own; even, >= 4
  MovesOfMotion(std::shared_ptr<const Motion> motion, FastestLaw law, std::size_t nodes);

  struct Move {
    MovePeriod period;
    std::shared_ptr<const GeometricPath> path;  ///< for FastestLaw::optimal
    std::vector<MotionSample> samples;          ///< by the path parameter, or by the time
    std::vector<double> steps;                  ///< distances of the samples in the path parameter
  };
  const std::vector<Move>& moves() const { return moves_; }
  const Motion& motion() const { return *motion_; }
  const std::shared_ptr<const Motion>& shared_motion() const { return motion_; }
  FastestLaw law() const { return law_; }
  /// Duration of the pause before move k; for k = moves().size(), that after the last move [s].
  double pause(std::size_t k) const;

 private:
  std::shared_ptr<const Motion> motion_;
  FastestLaw law_;
  std::vector<Move> moves_;
};

/// A mechanism with a design and limits.
struct DesignWithLimits {
  const Mechanism& mechanism;
  std::span<const double> parameters;
  const std::string& mode;
  const MotionLimits& limits;
  const Wrench<double>& wrench;
};

/// The result for one move.
struct FastestMove {
  double duration = 0;                               ///< [s]
  std::vector<PathPoint<double>> points;             ///< at the samples of the move
  std::shared_ptr<const SpeedProfile> profile = {};  ///< with FastestLaw::optimal
  double factor = 1;           ///< with FastestLaw::own: squared ratio of the speeds to those of the motion
  MotionSample limiting = {};  ///< with FastestLaw::own: the sample that limits the factor
  Violation limit = {};        ///< the limit that is active there
};

/// The shortest durations.
struct ShortestTimes {
  std::vector<FastestMove> moves;
  /// Factors in (0, 1] by which the continuous torques of the motors are kept: of their peak torques (with
  /// FastestLaw::optimal) and of all squared speeds; 1: they do not limit the motion.
  double torque_factor = 1, thermal_factor = 1;
  std::size_t thermal_joint = 0;  ///< the joint whose motor determines it
  double duration = 0;            ///< of the motion, with its pauses [s]
};

/// Throws DesignError if the mechanism does not assemble along the path, is singular there, or cannot perform the
/// motion at any speed.
ShortestTimes shortest_times(const MovesOfMotion& moves, const DesignWithLimits& design);

/// The duration of the motion [s] with its derivatives. @param found  shortest_times() of the design
Dual4 duration_with_derivatives(const MovesOfMotion& moves, const ShortestTimes& found, const DesignWithLimits& design,
                                std::span<const Dual4> parameters);

/// Limits with all peak torques of motors multiplied by a factor.
MotionLimits with_torques(const MotionLimits& limits, double factor);

/// "at t = 0.5 s of the motion"
std::string describe_time(const MotionSample& sample);

/// A time during which a limit is active.
struct ActivePeriod {
  LimitOfMotion limit;
  double begin = 0, end = 0;  ///< [s]
  Pose<double> from, to;      ///< poses at these times
};

struct FastestMotion {
  double duration = 0;  ///< [s]
  /// Estimate of the discretisation error of the duration [s]: the difference to twice as few nodes.
  double error = 0;
  std::shared_ptr<const Motion> motion;  ///< the fastest motion
  std::vector<MovePeriod> moves;         ///< its moves
  std::vector<ActivePeriod> active;
};

/// Computes the fastest motion as a motion, whose limits hold at all nodes and at `samples` equidistant times, to
/// rounding: where the limits are exceeded between the nodes, the move is slowed down.
FastestMotion find_fastest_motion(const MovesOfMotion& moves, const DesignWithLimits& design, std::size_t samples);

}  // namespace pkm
