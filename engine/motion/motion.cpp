#include "engine/motion/motion.hpp"

#include <cmath>

#include "engine/core/error.hpp"

namespace pkm {

std::vector<expression::Node> Motion::write(TimeGraph& to) const {
  std::vector<expression::Node> pose = write_(to);
  // Coordinates that are constant numbers become inputs of the graph: otherwise the graph would evaluate formulas of
  // them in advance in double precision, with rounding errors.
  for (expression::Node& node : pose)
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
  constexpr double kTolerance = 1e-9;
  const MotionSample first = motion.at(0), last = motion.at(motion.duration());
  const auto same = [](double a, double b) { return std::fabs(a - b) <= kTolerance; };
  const auto is_full_turn = [&](double angle) { return same(std::remainder(angle, 2 * kPi), 0); };
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double moved = last.pose[i] - first.pose[i];
    if (!(coordinates[i].turns() ? is_full_turn(moved) : same(moved, 0)) ||
        !same(first.velocity[i], last.velocity[i]) || !same(first.acceleration[i], last.acceleration[i]))
      return false;
  }
  for (std::size_t i = 0; i < last.inputs.size(); ++i) {
    const InputSample &from = first.inputs[i], &to = last.inputs[i];
    if (!is_full_turn(to.value - from.value) || !same(from.rate, to.rate) || !same(from.acceleration, to.acceleration))
      return false;
  }
  return true;
}

}  // namespace pkm
