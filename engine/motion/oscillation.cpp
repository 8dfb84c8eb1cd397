#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {
namespace {

class Oscillation final : public Motion {
 public:
  Oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude, double period, double cycles)
      : axes_(axes), centre_(centre), amplitude_(amplitude), rate_(2 * kPi / period), end_(cycles * period) {}

  double duration() const override { return end_; }
  MotionSample at(double time) const override {
    const auto [s, c] = sincos(rate_ * time);
    const double A = amplitude_, v = A * rate_, a = v * rate_;
    const AxisVector<double> still(centre_.size());
    MotionSample sample{time, centre_, still, still, {}};
    const auto add = [&](std::optional<std::size_t> axis, double way, double speed, double acceleration) {
      if (!axis) return;
      sample.pose[*axis] += way;
      sample.velocity[*axis] = speed;
      sample.acceleration[*axis] = acceleration;
    };
    add(axes_.x, A * s, v * c, -a * s);
    add(axes_.y, A * c, -v * s, -a * c);
    add(axes_.z, A * s, v * c, -a * s);
    return sample;
  }

 private:
  SpaceAxes axes_;
  AxisVector<double> centre_;
  double amplitude_, rate_, end_;
};

}  // namespace

std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles) {
  PKM_EXPECTS(period > 0 && cycles > 0);
  return std::make_shared<Oscillation>(axes, centre, amplitude, period, cycles);
}

}  // namespace pkm
