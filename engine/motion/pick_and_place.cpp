#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class Cycle final : public Motion {
 public:
  explicit Cycle(const PickAndPlace& cycle)
      : cycle_(cycle),
        reach_begins_(cycle.lift_time - cycle.overlap),
        lowering_begins_(reach_begins_ + cycle.reach_time - cycle.overlap),
        way_(lowering_begins_ + cycle.lift_time + cycle.wait) {
    const auto [s, c] = sincos(cycle.direction);
    along_ = {{cycle.reach * c, cycle.reach * s, 0, cycle.turn}};
  }

  double duration() const override { return cycle_.back ? 2 * way_ : way_; }
  MotionSample at(double time) const override {
    if (!cycle_.back || time <= way_) return there(time, time, cycle_.start, along_);
    return there(time, time - way_, cycle_.start + along_, along_ * -1.0);
  }

 private:
  /// @param t  since this way began
  MotionSample there(double time, double t, const Vector<double, 4>& from, const Vector<double, 4>& along) const {
    const Advance up = advance(cycle_.law, t, cycle_.lift_time, cycle_.lift);
    const Advance down = advance(cycle_.law, t - lowering_begins_, cycle_.lift_time, cycle_.lift);
    const Advance share = advance(cycle_.law, t - reach_begins_, cycle_.reach_time, 1);
    MotionSample sample{time, from + along * share.way, along * share.speed, along * share.acceleration};
    sample.pose[2] += up.way - down.way;
    sample.velocity[2] += up.speed - down.speed;
    sample.acceleration[2] += up.acceleration - down.acceleration;
    return sample;
  }

  PickAndPlace cycle_;
  double reach_begins_, lowering_begins_, way_;  ///< t_h, t_d, a way's duration
  Vector<double, 4> along_;
};

}  // namespace

std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle) {
  PKM_EXPECTS(cycle.lift_time > 0 && cycle.reach_time > 0 && cycle.overlap >= 0);
  PKM_EXPECTS(cycle.overlap <= cycle.lift_time && cycle.overlap <= cycle.reach_time);
  return std::make_shared<Cycle>(cycle);
}

}  // namespace pkm
