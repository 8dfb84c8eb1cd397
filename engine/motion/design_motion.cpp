#include "engine/motion/design_motion.hpp"

#include <cmath>
#include <limits>

namespace pkm {

std::vector<DualMotionSample> sample_with_derivatives(const DesignMotion& motion, std::span<const Dual4> design,
                                                      std::size_t count) {
  constexpr double kStep = 1e-4;      // step of the central differences, relative to the magnitude of the parameter
  constexpr double kSmallest = 0.01;  // magnitude [SI] that is assumed for a parameter with a smaller one, such as 0
  std::vector<double> values;
  for (const Dual4& parameter : design) values.push_back(parameter.a);
  const auto sample_at = [&](int k, double distance) {
    std::vector<double> moved = values;
    for (const std::size_t i : motion.parameters) moved[i] += distance * design[i].v[k];
    return sample(*motion.at(moved), count);
  };
  std::vector<DualMotionSample> samples;
  for (const MotionSample& at : sample(*motion.at(values), count))
    samples.push_back({Dual4(at.time), at.pose, at.velocity, at.acceleration});
  for (int k = 0; k < Dual4::kDerivatives; ++k) {
    double step = std::numeric_limits<double>::infinity();
    for (const std::size_t i : motion.parameters)
      if (design[i].v[k] != 0)
        step = std::fmin(step, kStep * std::fmax(std::fabs(values[i]), kSmallest) / std::fabs(design[i].v[k]));
    if (!std::isfinite(step)) continue;
    const auto ahead = sample_at(k, step), behind = sample_at(k, -step), far_ahead = sample_at(k, 2 * step),
               far_behind = sample_at(k, -2 * step);
    for (std::size_t j = 0; j < count; ++j) {
      const auto slope = [&](const auto& value) {
        return (8 * (value(ahead[j]) - value(behind[j])) - (value(far_ahead[j]) - value(far_behind[j]))) / (12 * step);
      };
      samples[j].time.v[k] = slope([](const MotionSample& at) { return at.time; });
      for (std::size_t i = 0; i < samples[j].pose.size(); ++i) {
        samples[j].pose[i].v[k] = slope([i](const MotionSample& at) { return at.pose[i]; });
        samples[j].velocity[i].v[k] = slope([i](const MotionSample& at) { return at.velocity[i]; });
        samples[j].acceleration[i].v[k] = slope([i](const MotionSample& at) { return at.acceleration[i]; });
      }
    }
  }
  return samples;
}

}  // namespace pkm
