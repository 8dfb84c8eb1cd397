#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class PointToPoint final : public Motion {
 public:
  PointToPoint(const AxisVector<double>& start, const std::vector<Move>& moves, double wait, TimeLaw law) : law_(law) {
    AxisVector<double> from = start;
    for (const Move& move : moves) {
      PKM_EXPECTS(move.duration > 0 && move.wait >= 0);
      end_ += move.wait;
      legs_.push_back({end_, move.duration, from, move.to});
      end_ += move.duration;
      from = move.to;
    }
    end_ += wait;
  }

  double duration() const override { return end_; }
  MotionSample at(double time) const override {
    // The last leg that has begun; a pause before the first belongs to it.
    const auto after =
        std::upper_bound(legs_.begin(), legs_.end(), time, [](double t, const Leg& leg) { return t < leg.begin; });
    const Leg& leg = after == legs_.begin() ? legs_.front() : *(after - 1);
    const Advance share = advance(law_, time - leg.begin, leg.duration, 1);
    const AxisVector<double> way = leg.to - leg.from;
    MotionSample sample;
    sample.time = time;
    sample.pose = leg.from + way * share.way;
    if (share.way == 1) sample.pose = leg.to;
    sample.velocity = way * share.speed;
    sample.acceleration = way * share.acceleration;
    return sample;
  }

 private:
  struct Leg {
    double begin, duration;
    AxisVector<double> from, to;
  };
  std::vector<Leg> legs_;
  double end_ = 0;
  TimeLaw law_;
};

}  // namespace

std::shared_ptr<const Motion> point_to_point(const AxisVector<double>& start, const std::vector<Move>& moves,
                                             double wait, TimeLaw law) {
  PKM_EXPECTS(!moves.empty());
  return std::make_shared<PointToPoint>(start, moves, wait, law);
}

double time_within(TimeLaw law, std::span<const AxisInfo> coordinates, const AxisVector<double>& from,
                   const AxisVector<double>& to, double acceleration, double angular_acceleration) {
  const AxisVector<double> way = to - from;
  double square = 0, time = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (coordinates[i].turns())
      time = std::max(time, time_of_move(law, way[i], angular_acceleration));
    else
      square += way[i] * way[i];
  }
  return std::max(time_of_move(law, std::sqrt(square), acceleration), time);
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
