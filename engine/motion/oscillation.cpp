// Harmonic oscillation.
#include "engine/core/error.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {

std::shared_ptr<const Motion> oscillation(const SpaceAxes& axes, const AxisVector<double>& centre, double amplitude,
                                          double period, double cycles) {
  PKM_EXPECTS(period > 0 && cycles > 0);
  const auto at = [=, rate = 2 * kPi / period](double time) {
    const auto [s, c] = sincos(rate * time);
    const double A = amplitude, v = A * rate, a = v * rate;
    const AxisVector<double> zero(centre.size());
    MotionSample sample{time, centre, zero, zero, {}};
    const auto add = [&sample](std::optional<std::size_t> axis, double offset, double speed, double acceleration) {
      if (!axis) return;
      sample.pose[*axis] += offset;
      sample.velocity[*axis] = speed;
      sample.acceleration[*axis] = acceleration;
    };
    add(axes.x, A * s, v * c, -a * s);
    add(axes.y, A * c, -v * s, -a * c);
    add(axes.z, A * s, v * c, -a * s);
    return sample;
  };
  const auto write = [=](TimeGraph& to) {
    const expression::Term phase = to.number(Interval(2 * kPi) / Interval(period)) * to.time, A = to.number(amplitude);
    std::vector<expression::Node> pose;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const expression::Term mean = to.number(centre[i]);
      const bool sine = i == axes.x || i == axes.z;
      pose.push_back((sine ? mean + A * sin(phase) : i == axes.y ? mean + A * cos(phase) : mean).node());
    }
    return pose;
  };
  return std::make_shared<const Motion>(cycles * period, at, write);
}

}  // namespace pkm
