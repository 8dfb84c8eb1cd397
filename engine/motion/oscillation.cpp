#include "engine/core/error.hpp"
#include "engine/motion/motions.hpp"

namespace pkm {

std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles) {
  PKM_EXPECTS(period > 0 && cycles > 0);
  const auto at = [=, rate = 2 * kPi / period](double time) {
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
  };
  const auto write = [=](TimeGraph& to) {
    const graph::Term turn = to.number(Interval(2 * kPi) / Interval(period)) * to.time, A = to.number(amplitude);
    std::vector<graph::Node> pose;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const graph::Term middle = to.number(centre[i]);
      const bool sine = i == axes.x || i == axes.z;
      pose.push_back((sine ? middle + A * sin(turn) : i == axes.y ? middle + A * cos(turn) : middle).node());
    }
    return pose;
  };
  return std::make_shared<const Motion>(cycles * period, at, write);
}

}  // namespace pkm
