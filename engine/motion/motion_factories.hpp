// Factory functions of the built-in kinds of motions: point to point, oscillation, pick and place, formulas of time.
// All values are in SI units.
#pragma once

#include <limits>
#include <optional>

#include "engine/expression/formula.hpp"
#include "engine/motion/motion.hpp"
#include "engine/motion/time_law.hpp"

namespace pkm {

/// A pause, followed by a rest-to-rest move on a straight line in the space of the coordinates.
struct Move {
  double wait = 0;        ///< pause before the move [s]
  AxisVector<double> to;  ///< pose at the end of the move
  double duration = 0;    ///< duration of the move, > 0 [s]
};

/// A sequence of moves, at rest at each point.
/// @param wait  pause at the last point [s]
std::shared_ptr<const Motion> point_to_point(const AxisVector<double>& start, const std::vector<Move>& moves,
                                             double wait, TimeLaw law);

/// Upper bounds of peak speeds and accelerations of a move, for the position and for each angle; infinite: unlimited.
struct PeakRates {
  double acceleration = std::numeric_limits<double>::infinity();  ///< maximum acceleration of the position [m/s^2]
  double angular_acceleration = std::numeric_limits<double>::infinity();  ///< maximum angular acceleration [rad/s^2]
  double speed = std::numeric_limits<double>::infinity();                 ///< maximum speed of the position [m/s]
  double angular_speed = std::numeric_limits<double>::infinity();         ///< maximum angular speed [rad/s]
};

/// The shortest duration [s] of a move that satisfies the limits; 0 if no limited coordinate moves.
/// @param limits  linear limits apply to the vector of all coordinates that are lengths
double min_move_duration(TimeLaw law, std::span<const AxisInfo> coordinates, const AxisVector<double>& from,
                         const AxisVector<double>& to, const PeakRates& limits);

/// Indices of the coordinates x, y, z and of the rotation of the platform; std::nullopt if the platform does not have
/// the coordinate.
struct SpaceAxes {
  std::optional<std::size_t> x, y, z, turn;
};
/// Finds the lengths named x, y, z, and the first angle as `turn`.
SpaceAxes space_axes(std::span<const AxisInfo> coordinates);

/// Harmonic oscillation x = x0 + A sin wt, y = y0 + A cos wt, z = z0 + A sin wt with w = 2 pi / period. Coordinates
/// that the platform lacks are omitted; all other coordinates are constant. Source: Transactions of the Chinese Society
/// for Agricultural Machinery 54 (9), 2023, 448-458, eq 35.
std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles);

/// Pick-and-place cycle: lift, move along a horizontal line and rotate, lower. With t_h = T_v - o, t_d = t_h + T_h - o,
///   z = z0 + Q(t, T_v, lift) - Q(t - t_d, T_v, lift)
///   (x, y) = (x0, y0) + (cos d, sin d) Q(t - t_h, T_h, reach),   rotation = rotation0 + Q(t - t_h, T_h, turn)
/// where Q(t, T, s) is the time law: it increases from 0 to s for t from 0 to T. One direction takes the time t_d +
/// T_v. Coordinates that the cycle does not move may be missing.
struct PickAndPlace {
  SpaceAxes axes;
  AxisVector<double> start;
  double lift = 0.025, reach = 0.305;  ///< height of the lift, and length of the horizontal line [m]
  double lift_time = 0.1;              ///< duration T_v of the lift and of the lowering, > 0 [s]
  double reach_time = 0.3;             ///< duration T_h of the horizontal movement, > 0 [s]
  /// Overlap o of consecutive movements [s], in [0, min(T_v, T_h)]; 0: rest at both corners of the path.
  double overlap = 0;
  double direction = 0;  ///< direction d of the horizontal movement: angle from the x axis towards the y axis [rad]
  double turn = 0;       ///< rotation of the platform during the horizontal movement [rad]
  double wait = 0;       ///< pause after the movement in each direction [s]
  bool back = false;     ///< true: the cycle includes the return along the same path
  TimeLaw law = TimeLaw::quintic;
};
std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle);

/// A motion with a formula of the time t [s] for each coordinate; derivatives by automatic differentiation. Undefined
/// values are NaN in the samples.
std::shared_ptr<const Motion> motion_from_formulas(const std::vector<Formula>& coordinates, double duration);

/// A motion through a table of poses: a cubic spline for each coordinate. It has no expression graph: Motion::write()
/// throws std::invalid_argument.
/// @param times        strictly increasing from 0, at least four [s]
/// @param coordinates  for each coordinate its values at these times
std::shared_ptr<const Motion> motion_from_table(const std::vector<double>& times,
                                                const std::vector<std::vector<double>>& coordinates);

/// A copy of a motion with the mechanism's inputs (MechanismInfo::inputs, in their order, SI units) as formulas of the
/// time.
std::shared_ptr<const Motion> with_inputs(std::shared_ptr<const Motion> motion, const std::vector<Formula>& inputs);

/// The variables of formulas of time: "t".
inline const std::vector<std::string>& time_name() {
  static const std::vector<std::string> names = {"t"};
  return names;
}

}  // namespace pkm
