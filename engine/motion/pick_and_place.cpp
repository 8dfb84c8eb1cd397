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
    along_ = AxisVector<double>(cycle.start.size());
    const auto set = [this](std::optional<std::size_t> axis, double way) {
      PKM_EXPECTS(axis || way == 0);
      if (axis) along_[*axis] = way;
    };
    set(cycle.axes.x, cycle.reach * c);
    set(cycle.axes.y, cycle.reach * s);
    set(cycle.axes.turn, cycle.turn);
  }

  double duration() const override { return cycle_.back ? 2 * way_ : way_; }
  MotionSample at(double time) const override {
    if (!cycle_.back || time <= way_) return there(time, time, cycle_.start, along_);
    return there(time, time - way_, cycle_.start + along_, along_ * -1.0);
  }

 private:
  /// @param t  since this way began
  MotionSample there(double time, double t, const AxisVector<double>& from, const AxisVector<double>& along) const {
    const Advance up = advance(cycle_.law, t, cycle_.lift_time, cycle_.lift);
    const Advance down = advance(cycle_.law, t - lowering_begins_, cycle_.lift_time, cycle_.lift);
    const Advance share = advance(cycle_.law, t - reach_begins_, cycle_.reach_time, 1);
    MotionSample sample{time, from + along * share.way, along * share.speed, along * share.acceleration, {}};
    if (const auto z = cycle_.axes.z) {
      sample.pose[*z] += up.way - down.way;
      sample.velocity[*z] += up.speed - down.speed;
      sample.acceleration[*z] += up.acceleration - down.acceleration;
    }
    return sample;
  }

  PickAndPlace cycle_;
  double reach_begins_, lowering_begins_, way_;  ///< t_h, t_d, a way's duration
  AxisVector<double> along_;
};

}  // namespace

std::shared_ptr<const Motion> pick_and_place(const PickAndPlace& cycle) {
  PKM_EXPECTS(cycle.axes.z || cycle.lift == 0);
  PKM_EXPECTS(cycle.lift_time > 0 && cycle.reach_time > 0 && cycle.overlap >= 0);
  PKM_EXPECTS(cycle.overlap <= cycle.lift_time && cycle.overlap <= cycle.reach_time);
  return std::make_shared<Cycle>(cycle);
}

}  // namespace pkm
