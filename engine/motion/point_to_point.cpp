#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

struct Leg {
  double begin, duration;
  AxisVector<double> from, to;
};

/// Where it starts and every move's share: of those that have not begun nothing, of those that have ended all.
std::vector<graph::Node> write_moves(const AxisVector<double>& start, const std::vector<Move>& moves, TimeLaw law,
                                     TimeGraph& to) {
  std::vector<graph::Term> pose;
  for (const double value : start) pose.push_back(to.number(value));
  Interval begin(0.0);
  AxisVector<double> from = start;
  for (const Move& move : moves) {
    begin += Interval(move.wait);
    const graph::Term share = share_of_way(law, to, begin, move.duration);
    for (std::size_t i = 0; i < pose.size(); ++i)
      pose[i] = pose[i] + to.number(Interval(move.to[i]) - Interval(from[i])) * share;
    begin += Interval(move.duration);
    from = move.to;
  }
  std::vector<graph::Node> nodes;
  for (const graph::Term& coordinate : pose) nodes.push_back(coordinate.node());
  return nodes;
}

}  // namespace

std::shared_ptr<const Motion> point_to_point(const AxisVector<double>& start, const std::vector<Move>& moves,
                                             double wait, TimeLaw law) {
  PKM_EXPECTS(!moves.empty());
  std::vector<Leg> legs;
  double end = 0;
  for (const Move& move : moves) {
    PKM_EXPECTS(move.duration > 0 && move.wait >= 0);
    end += move.wait;
    legs.push_back({end, move.duration, legs.empty() ? start : legs.back().to, move.to});
    end += move.duration;
  }
  const auto at = [legs = std::move(legs), law](double time) {
    // The last leg that has begun; a pause before the first belongs to it.
    const auto after = std::ranges::upper_bound(legs, time, {}, &Leg::begin);
    const Leg& leg = after == legs.begin() ? legs.front() : *(after - 1);
    const Advance share = advance(law, time - leg.begin, leg.duration, 1);
    const AxisVector<double> way = leg.to - leg.from;
    const AxisVector<double> pose = share.way == 1 ? leg.to : leg.from + way * share.way;
    return MotionSample{time, pose, way * share.speed, way * share.acceleration, {}};
  };
  return std::make_shared<const Motion>(end + wait, at,
                                        [=](TimeGraph& to) { return write_moves(start, moves, law, to); });
}

double time_within(TimeLaw law, std::span<const AxisInfo> coordinates, const AxisVector<double>& from,
                   const AxisVector<double>& to, const PeakRates& most) {
  const auto time_of = [law](double way, double acceleration, double speed) {
    return std::max(time_of_move(law, way, acceleration), peak_speed(law) * std::fabs(way) / speed);
  };
  const AxisVector<double> way = to - from;
  double square = 0, time = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (coordinates[i].turns())
      time = std::max(time, time_of(way[i], most.angular_acceleration, most.angular_speed));
    else
      square += way[i] * way[i];
  }
  return std::max(time_of(std::sqrt(square), most.acceleration, most.speed), time);
}

SpaceAxes space_axes(std::span<const AxisInfo> coordinates) {
  SpaceAxes axes;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const AxisInfo& axis = coordinates[i];
    if (axis.turns() && !axes.turn) axes.turn = i;
    if (axis.turns()) continue;
    if (axis.name == "x") axes.x = i;
    if (axis.name == "y") axes.y = i;
    if (axis.name == "z") axes.z = i;
  }
  return axes;
}

}  // namespace pkm
