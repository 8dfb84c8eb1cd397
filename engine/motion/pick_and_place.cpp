// Pick-and-place cycle.
#include "engine/core/error.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

/// A sample of the forward or the return movement of a cycle.
/// @param t      time since the movement began
/// @param along  horizontal displacement and rotation over the whole movement
MotionSample sample_way(const PickAndPlace& cycle, double time, double t, const AxisVector<double>& from,
                        const AxisVector<double>& along) {
  const double reach_begins = cycle.lift_time - cycle.overlap;                     // time t_h of PickAndPlace
  const double lowering_begins = reach_begins + cycle.reach_time - cycle.overlap;  // time t_d of PickAndPlace
  const PathState up = evaluate(cycle.law, t, cycle.lift_time, cycle.lift);
  const PathState down = evaluate(cycle.law, t - lowering_begins, cycle.lift_time, cycle.lift);
  const PathState s = evaluate(cycle.law, t - reach_begins, cycle.reach_time, 1);
  MotionSample sample{time, from + along * s.distance, along * s.speed, along * s.acceleration, {}};
  if (const auto z = cycle.axes.z) {
    sample.pose[*z] += up.distance - down.distance;
    sample.velocity[*z] += up.speed - down.speed;
    sample.acceleration[*z] += up.acceleration - down.acceleration;
  }
  return sample;
}

/// The forward or the return movement of a cycle as expressions of the time.
/// @param begin  time at which the movement begins
/// @return height above the start, and fraction of the displacement `along`
std::array<expression::Term, 2> write_way(const PickAndPlace& cycle, TimeGraph& to, const Interval& begin) {
  const Interval reach_begins = begin + Interval(cycle.lift_time) - Interval(cycle.overlap);
  const Interval lowering_begins = reach_begins + Interval(cycle.reach_time) - Interval(cycle.overlap);
  const auto law = [&](const Interval& from, double duration) { return path_fraction(cycle.law, to, from, duration); };
  return {to.number(cycle.lift) * (law(begin, cycle.lift_time) - law(lowering_begins, cycle.lift_time)),
          law(reach_begins, cycle.reach_time)};
}

std::vector<expression::Node> write_cycle(const PickAndPlace& cycle, TimeGraph& to) {
  const Interval direction(cycle.direction), reach(cycle.reach);
  auto [lifted, fraction] = write_way(cycle, to, 0.0);
  if (cycle.back) {
    const Interval back_begins = Interval(cycle.lift_time) - Interval(cycle.overlap) + Interval(cycle.reach_time) -
                                 Interval(cycle.overlap) + Interval(cycle.lift_time) + Interval(cycle.wait);
    const auto [lifted_again, fraction_back] = write_way(cycle, to, back_begins);
    lifted = lifted + lifted_again;
    fraction = fraction - fraction_back;
  }
  std::vector<expression::Node> pose;
  for (std::size_t i = 0; i < cycle.start.size(); ++i) {
    expression::Term at = to.number(cycle.start[i]);
    if (i == cycle.axes.x) at = at + to.number(reach * cos(direction)) * fraction;
    if (i == cycle.axes.y) at = at + to.number(reach * sin(direction)) * fraction;
    if (i == cycle.axes.turn) at = at + to.number(cycle.turn) * fraction;
    if (i == cycle.axes.z) at = at + lifted;
    pose.push_back(at.node());
  }
  return pose;
}

}  // namespace

std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle) {
  PKM_EXPECTS(cycle.axes.z || cycle.lift == 0);
  PKM_EXPECTS(cycle.lift_time > 0 && cycle.reach_time > 0 && cycle.overlap >= 0);
  PKM_EXPECTS(cycle.overlap <= cycle.lift_time && cycle.overlap <= cycle.reach_time);
  const double end = cycle.lift_time - cycle.overlap + cycle.reach_time - cycle.overlap + cycle.lift_time + cycle.wait;
  const auto [s, c] = sincos(cycle.direction);
  AxisVector<double> along(cycle.start.size());
  const auto set = [&along](std::optional<std::size_t> axis, double moved) {
    PKM_EXPECTS(axis || moved == 0);
    if (axis) along[*axis] = moved;
  };
  set(cycle.axes.x, cycle.reach * c);
  set(cycle.axes.y, cycle.reach * s);
  set(cycle.axes.turn, cycle.turn);
  const auto at = [cycle, end, along](double time) {
    if (!cycle.back || time <= end) return sample_way(cycle, time, time, cycle.start, along);
    return sample_way(cycle, time, time - end, cycle.start + along, along * -1.0);
  };
  return std::make_shared<const Motion>(cycle.back ? 2 * end : end, at,
                                        [cycle](TimeGraph& to) { return write_cycle(cycle, to); });
}

}  // namespace pkm
