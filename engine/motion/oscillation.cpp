#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {

std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles) {
  PKM_EXPECTS(period > 0 && cycles > 0);
  return std::make_shared<const Motion>(cycles * period, [=, rate = 2 * kPi / period](double time) {
    const auto [s, c] = sincos(rate * time);
    const double A = amplitude, v = A * rate, a = v * rate;
    const AxisVector<double> still(centre.size());
    MotionSample sample{time, centre, still, still, {}};
    const auto add = [&sample](std::optional<std::size_t> axis, double way, double speed, double acceleration) {
      if (!axis) return;
      sample.pose[*axis] += way;
      sample.velocity[*axis] = speed;
      sample.acceleration[*axis] = acceleration;
    };
    add(axes.x, A * s, v * c, -a * s);
    add(axes.y, A * c, -v * s, -a * c);
    add(axes.z, A * s, v * c, -a * s);
    return sample;
  });
}

}  // namespace pkm
