// The kinds of motions: one maker each. All numbers in SI.
#pragma once

#include <limits>
#include <optional>

#include "engine/graph/formula.hpp"
#include "engine/motion/motion.hpp"
#include "engine/motion/time_law.hpp"

namespace pkm {

/// A pause, then a move in a straight line of all coordinates, from rest to rest.
struct Move {
  double wait = 0;        ///< [s], before it
  AxisVector<double> to;  ///< where it ends
  double duration = 0;    ///< [s], > 0
};

/// From point to point, at rest at each; `wait` [s] at the last.
std::shared_ptr<const Motion> point_to_point(const AxisVector<double>& start, const std::vector<Move>& moves,
                                             double wait, TimeLaw law);

/// Peaks that a move keeps to, of the position and of each angle; an infinite one bounds nothing.
struct PeakRates {
  double acceleration = std::numeric_limits<double>::infinity();          ///< [m/s^2]
  double angular_acceleration = std::numeric_limits<double>::infinity();  ///< [rad/s^2]
  double speed = std::numeric_limits<double>::infinity();                 ///< [m/s]
  double angular_speed = std::numeric_limits<double>::infinity();         ///< [rad/s]
};

/// Time [s] of a move within these; 0 where nothing bounded moves.
double time_within(TimeLaw law, std::span<const AxisInfo> coordinates, const AxisVector<double>& from,
                   const AxisVector<double>& to, const PeakRates& most);

/// Which coordinates are x, y, z and the platform's turn, for motions that name them; none: the platform has it not.
struct SpaceAxes {
  std::optional<std::size_t> x, y, z, turn;
};
/// Lengths called x, y, z; the first angle.
SpaceAxes space_axes(std::span<const AxisInfo> coordinates);

/// x = x0 + A sin wt, y = y0 + A cos wt, z = z0 + A sin wt, as far as the platform has
/// them, other coordinates constant; w = 2 pi/period. Source: Transactions of
/// the Chinese Society for Agricultural Machinery 54 (9), 2023, 448-458, eq 35.
std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles);

/// The handling cycle: lift, reach along a horizontal line and turn, lower. With t_h = T_v - o, t_d = t_h + T_h - o,
///   z = z0 + Q(t, T_v, lift) - Q(t - t_d, T_v, lift)
///   (x, y) = (x0, y0) + (cos d, sin d) Q(t - t_h, T_h, reach),   rotation = rotation0 + Q(t - t_h, T_h, turn)
/// where Q goes from 0 to its last argument by the time law; it takes t_d + T_v. What does not move needs no axis.
struct PickAndPlace {
  SpaceAxes axes;
  AxisVector<double> start;
  double lift = 0.025, reach = 0.305;  ///< [m]
  double lift_time = 0.1;              ///< T_v [s], > 0
  double reach_time = 0.3;             ///< T_h [s], > 0
  double overlap = 0;                  ///< o [s], in [0, min(T_v, T_h)]: 0 stops at the corners
  double direction = 0;                ///< d [rad], from x towards y
  double turn = 0;                     ///< [rad]
  double wait = 0;                     ///< [s], at the end of each way
  bool back = false;                   ///< the same way back: a whole cycle
  TimeLaw law = TimeLaw::quintic;
};
std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle);

/// A formula of the time t [s] for each coordinate; derivatives are exact. What is undefined is NaN in the samples.
std::shared_ptr<const Motion> formulas_of_time(const std::vector<Formula>& coordinates, double duration);

/// The same motion, with the auxiliary chain's input [rad] as a formula of the time.
std::shared_ptr<const Motion> with_input(std::shared_ptr<const Motion> motion, const Formula& input);

/// The only name that formulas of time know.
inline const std::vector<std::string>& time_name() {
  static const std::vector<std::string> names = {"t"};
  return names;
}

}  // namespace pkm
