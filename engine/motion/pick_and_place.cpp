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

/// One way of the cycle as formulas of the time: how far the platform is lifted, and its share of the reach.
/// @param begin  of the way
std::array<graph::Term, 2> write_way(const PickAndPlace& cycle, TimeGraph& to, const Interval& begin) {
  const Interval reach_begins = begin + Interval(cycle.lift_time) - Interval(cycle.overlap);
  const Interval lowering_begins = reach_begins + Interval(cycle.reach_time) - Interval(cycle.overlap);
  const auto share = [&](const Interval& from, double duration) { return share_of_way(cycle.law, to, from, duration); };
  return {to.number(cycle.lift) * (share(begin, cycle.lift_time) - share(lowering_begins, cycle.lift_time)),
          share(reach_begins, cycle.reach_time)};
}

std::vector<graph::Node> write_cycle(const PickAndPlace& cycle, TimeGraph& to) {
  const Interval direction(cycle.direction), reach(cycle.reach);
  auto [lifted, share] = write_way(cycle, to, 0.0);
  if (cycle.back) {
    const Interval way = Interval(cycle.lift_time) - Interval(cycle.overlap) + Interval(cycle.reach_time) -
                         Interval(cycle.overlap) + Interval(cycle.lift_time) + Interval(cycle.wait);
    const auto [lifted_again, share_back] = write_way(cycle, to, way);
    lifted = lifted + lifted_again;
    share = share - share_back;
  }
  std::vector<graph::Node> pose;
  for (std::size_t i = 0; i < cycle.start.size(); ++i) {
    graph::Term at = to.number(cycle.start[i]);
    if (i == cycle.axes.x) at = at + to.number(reach * cos(direction)) * share;
    if (i == cycle.axes.y) at = at + to.number(reach * sin(direction)) * share;
    if (i == cycle.axes.turn) at = at + to.number(cycle.turn) * share;
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
  const auto at = [cycle, way, along](double time) {
    if (!cycle.back || time <= way) return there(cycle, time, time, cycle.start, along);
    return there(cycle, time, time - way, cycle.start + along, along * -1.0);
  };
  return std::make_shared<const Motion>(cycle.back ? 2 * way : way, at,
                                        [cycle](TimeGraph& to) { return write_cycle(cycle, to); });
}

}  // namespace pkm
