#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class PointToPoint final : public Motion {
 public:
  PointToPoint(const Vector<double, 4>& start, const std::vector<Move>& moves, double wait, TimeLaw law) : law_(law) {
    Vector<double, 4> from = start;
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
    const Vector<double, 4> way = leg.to - leg.from;
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
    Vector<double, 4> from, to;
  };
  std::vector<Leg> legs_;
  double end_ = 0;
  TimeLaw law_;
};

}  // namespace

std::shared_ptr<const Motion> point_to_point(const Vector<double, 4>& start, const std::vector<Move>& moves,
                                             double wait, TimeLaw law) {
  PKM_EXPECTS(!moves.empty());
  return std::make_shared<PointToPoint>(start, moves, wait, law);
}

double time_within(TimeLaw law, const Vector<double, 4>& from, const Vector<double, 4>& to, double acceleration,
                   double angular_acceleration) {
  const Vector<double, 4> way = to - from;
  const double distance = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  return std::max(time_of_move(law, distance, acceleration), time_of_move(law, way[3], angular_acceleration));
}

}  // namespace pkm
