#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

/// One way of the cycle.
/// @param t  since it began
MotionSample there(const PickAndPlace& cycle, double time, double t, const AxisVector<double>& from,
                   const AxisVector<double>& along) {
  const double reach_begins = cycle.lift_time - cycle.overlap;                     // t_h
  const double lowering_begins = reach_begins + cycle.reach_time - cycle.overlap;  // t_d
  const Advance up = advance(cycle.law, t, cycle.lift_time, cycle.lift);
  const Advance down = advance(cycle.law, t - lowering_begins, cycle.lift_time, cycle.lift);
  const Advance share = advance(cycle.law, t - reach_begins, cycle.reach_time, 1);
  MotionSample sample{time, from + along * share.way, along * share.speed, along * share.acceleration, {}};
  if (const auto z = cycle.axes.z) {
    sample.pose[*z] += up.way - down.way;
    sample.velocity[*z] += up.speed - down.speed;
    sample.acceleration[*z] += up.acceleration - down.acceleration;
  }
  return sample;
}

}  // namespace

std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle) {
  PKM_EXPECTS(cycle.axes.z || cycle.lift == 0);
  PKM_EXPECTS(cycle.lift_time > 0 && cycle.reach_time > 0 && cycle.overlap >= 0);
  PKM_EXPECTS(cycle.overlap <= cycle.lift_time && cycle.overlap <= cycle.reach_time);
  const double way = cycle.lift_time - cycle.overlap + cycle.reach_time - cycle.overlap + cycle.lift_time + cycle.wait;
  const auto [s, c] = sincos(cycle.direction);
  AxisVector<double> along(cycle.start.size());
  const auto set = [&along](std::optional<std::size_t> axis, double moved) {
    PKM_EXPECTS(axis || moved == 0);
    if (axis) along[*axis] = moved;
  };
  set(cycle.axes.x, cycle.reach * c);
  set(cycle.axes.y, cycle.reach * s);
  set(cycle.axes.turn, cycle.turn);
  return std::make_shared<const Motion>(cycle.back ? 2 * way : way, [cycle, way, along](double time) {
    if (!cycle.back || time <= way) return there(cycle, time, time, cycle.start, along);
    return there(cycle, time, time - way, cycle.start + along, along * -1.0);
  });
}

}  // namespace pkm
