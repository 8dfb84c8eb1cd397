// Time laws (motion laws) of rest-to-rest moves: the travelled fraction s(u) of the path as a function of u = t/T, both
// in [0, 1].
//
//   quintic  s = 10 u^3 - 15 u^4 + 6 u^5          peak speed 1.875 S/T   peak acceleration 10/sqrt(3) S/T^2
//   cycloid  s = u - sin(2 pi u)/(2 pi)            peak speed 2 S/T       peak acceleration 2 pi S/T^2
//   trapezoid  s = 9/4 u^2, 3/2 u - 1/4, 1 - 9/4 (1 - u)^2 in thirds of T
//                                                  peak speed 1.5 S/T     peak acceleration 4.5 S/T^2
//
// where S is the length of the path. All start and end with zero speed, the first two also with zero acceleration.
//
// Reference: Biagiotti, Melchiorri, "Trajectory Planning for Automatic Machines and Robots", Springer 2008, chapter 2.
#pragma once

#include "engine/motion/time_graph.hpp"

namespace pkm {

enum class TimeLaw { quintic, cycloid, trapezoid };

/// Travelled distance along a move, and its time derivatives.
struct PathState {
  double distance = 0, speed = 0, acceleration = 0;
};

/// Distance, speed and acceleration of a move at a time. Before its start and after its end, the move is at rest.
/// @param time  time since the start of the move [s]
PathState evaluate(TimeLaw law, double time, double duration, double distance);

/// The travelled fraction of a move, in [0, 1], as an expression of the time.
/// @param begin  time at which the move starts
expression::Term path_fraction(TimeLaw law, TimeGraph& graph, const Interval& begin, double duration);

/// Peak acceleration of a move over the distance 1 in the time 1.
double peak_acceleration(TimeLaw law);

/// Peak speed of a move over the distance 1 in the time 1.
double peak_speed(TimeLaw law);

/// Duration [s] of a move over `distance` whose peak acceleration is `peak`.
double move_duration(TimeLaw law, double distance, double peak);

}  // namespace pkm
