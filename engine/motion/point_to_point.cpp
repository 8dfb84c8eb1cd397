// Point-to-point motions.
#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

struct Leg {
  double begin, duration;
  AxisVector<double> from, to;
};

/// The pose as an expression of the time: the start plus the displacement of every move times its fraction, which is 0
/// before the move and 1 after it.
std::vector<expression::Node> write_moves(const AxisVector<double>& start, const std::vector<Move>& moves, TimeLaw law,
                                          TimeGraph& to) {
  std::vector<expression::Term> pose;
  for (const double value : start) pose.push_back(to.number(value));
  Interval begin(0.0);
  AxisVector<double> from = start;
  for (const Move& move : moves) {
    begin += Interval(move.wait);
    const expression::Term fraction = path_fraction(law, to, begin, move.duration);
    for (std::size_t i = 0; i < pose.size(); ++i)
      pose[i] = pose[i] + to.number(Interval(move.to[i]) - Interval(from[i])) * fraction;
    begin += Interval(move.duration);
    from = move.to;
  }
  std::vector<expression::Node> nodes;
  for (const expression::Term& coordinate : pose) nodes.push_back(coordinate.node());
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
    // Use the last leg that has begun or, during the pause before the first leg, the first one.
    const auto after = std::ranges::upper_bound(legs, time, {}, &Leg::begin);
    const Leg& leg = after == legs.begin() ? legs.front() : *(after - 1);
    const PathState fraction = evaluate(law, time - leg.begin, leg.duration, 1);
    const AxisVector<double> way = leg.to - leg.from;
    const AxisVector<double> pose = fraction.distance == 1 ? leg.to : leg.from + way * fraction.distance;
    return MotionSample{time, pose, way * fraction.speed, way * fraction.acceleration, {}};
  };
  return std::make_shared<const Motion>(end + wait, at,
                                        [=](TimeGraph& to) { return write_moves(start, moves, law, to); });
}

double min_move_duration(TimeLaw law, std::span<const AxisInfo> coordinates, const AxisVector<double>& from,
                         const AxisVector<double>& to, const PeakRates& limits) {
  const auto duration = [law](double distance, double acceleration, double speed) {
    return std::max(move_duration(law, distance, acceleration), peak_speed(law) * std::fabs(distance) / speed);
  };
  const AxisVector<double> way = to - from;
  double square = 0, time = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (coordinates[i].turns())
      time = std::max(time, duration(way[i], limits.angular_acceleration, limits.angular_speed));
    else
      square += way[i] * way[i];
  }
  return std::max(duration(std::sqrt(square), limits.acceleration, limits.speed), time);
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
