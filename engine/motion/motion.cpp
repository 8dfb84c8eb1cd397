#include "engine/motion/motion.hpp"

#include <cmath>

#include "engine/core/error.hpp"

namespace pkm {

std::vector<graph::Node> Motion::write(TimeGraph& to) const {
  std::vector<graph::Node> pose = write_(to);
  for (graph::Node& node : pose)  // a number would be folded, and so rounded, with those of a mechanism
    if (to.graph[node].is_number()) node = to.input(to.graph[node].number).node();
  return pose;
}

std::vector<MotionSample> sample(const Motion& motion, std::size_t count) {
  PKM_EXPECTS(count >= 2);
  const double end = motion.duration();
  std::vector<MotionSample> samples;
  for (std::size_t k = 0; k + 1 < count; ++k)
    samples.push_back(motion.at(end * static_cast<double>(k) / static_cast<double>(count - 1)));
  samples.push_back(motion.at(end));
  return samples;
}

bool is_periodic(const Motion& motion, std::span<const AxisInfo> coordinates) {
  constexpr double kSame = 1e-9;
  const MotionSample first = motion.at(0), last = motion.at(motion.duration());
  const auto same = [](double a, double b) { return std::fabs(a - b) <= kSame; };
  const auto no_turn = [&](double turned) { return same(std::remainder(turned, 2 * kPi), 0); };
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double moved = last.pose[i] - first.pose[i];
    if (!(coordinates[i].turns() ? no_turn(moved) : same(moved, 0)) || !same(first.velocity[i], last.velocity[i]) ||
        !same(first.acceleration[i], last.acceleration[i]))
      return false;
  }
  return no_turn(last.input.angle - first.input.angle) && same(first.input.speed, last.input.speed) &&
         same(first.input.acceleration, last.input.acceleration);
}

}  // namespace pkm
