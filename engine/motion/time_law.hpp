// From rest to rest: how far along its way a move is, s(u) in [0, 1] with u = t/T.
//
//   quintic  s = 10 u^3 - 15 u^4 + 6 u^5          peak speed 1.875 S/T   peak acceleration 10/sqrt(3) S/T^2
//   cycloid  s = u - sin(2 pi u)/(2 pi)            peak speed 2 S/T       peak acceleration 2 pi S/T^2
//
// Both begin and end with speed and acceleration 0.
#pragma once

#include "engine/motion/time_formulas.hpp"

namespace pkm {

enum class TimeLaw { quintic, cycloid };

/// A distance along a move, and its derivatives by time.
struct Advance {
  double way = 0, speed = 0, acceleration = 0;
};

/// A move over `way` in the time `duration`, at `time` after its beginning; at rest before and behind.
Advance advance(TimeLaw law, double time, double duration, double way);

/// The same way over 1, as a formula of the time in which a move begins.
graph::Term share_of_way(TimeLaw law, TimeGraph& graph, const Interval& begin, double duration);

/// Peak acceleration of a move over 1 in the time 1.
double peak_acceleration(TimeLaw law);

/// Peak speed of a move over 1 in the time 1.
double peak_speed(TimeLaw law);

/// Time [s] in which a move over `way` reaches the peak acceleration `peak` and no more.
double time_of_move(TimeLaw law, double way, double peak);

}  // namespace pkm
