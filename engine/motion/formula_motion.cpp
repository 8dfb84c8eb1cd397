// Motions given by formulas of time.
#include "engine/core/error.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/math/taylor.hpp"
#include "engine/motion/motion_factories.hpp"

namespace pkm {
namespace {

/// The value of a formula at a time, with its first and second time derivatives.
Taylor at_time(const Formula& formula, double time) {
  const Taylor t = Taylor::variable(time);
  return formula.value(std::span<const Taylor>(&t, 1));
}

}  // namespace

std::shared_ptr<const Motion> with_inputs(std::shared_ptr<const Motion> motion, const std::vector<Formula>& inputs) {
  const auto at = [motion, inputs](double time) {
    MotionSample sample = motion->at(time);
    for (const Formula& input : inputs) {
      const Taylor value = at_time(input, time);
      sample.inputs.push_back({value.a, value.d, value.dd});
    }
    return sample;
  };
  return std::make_shared<const Motion>(motion->duration(), at, [motion](TimeGraph& to) { return motion->write(to); });
}

std::shared_ptr<const Motion> motion_from_formulas(const std::vector<Formula>& coordinates, double duration) {
  PKM_EXPECTS(duration > 0);
  const auto at = [coordinates](double time) {
    MotionSample sample;
    sample.time = time;
    sample.pose = sample.velocity = sample.acceleration = AxisVector<double>(coordinates.size());
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const Taylor x = at_time(coordinates[i], time);
      sample.pose[i] = x.a;
      sample.velocity[i] = x.d;
      sample.acceleration[i] = x.dd;
    }
    return sample;
  };
  return std::make_shared<const Motion>(duration, at, [coordinates](TimeGraph& to) {
    std::vector<expression::Node> pose;
    const expression::Node time = to.time.node();
    for (const Formula& formula : coordinates)
      pose.push_back(expression::read_formula(to.graph, formula.text(), time_name(), {&time, 1}));
    return pose;
  });
}

}  // namespace pkm
