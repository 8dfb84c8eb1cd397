#include "engine/mechanism/sampled_poses.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/math/halton.hpp"

namespace pkm {

SampledPoses::SampledPoses(const Mechanism& mechanism, std::span<const double> parameters, double reach) {
  auto ranges = mechanism.ranges(parameters);
  if (!ranges) throw DesignError("no pose can be sampled, because the ranges of the coordinates are unknown");
  ranges_ = std::move(*ranges);
  for (const int fixed : mechanism.info().sweeps.front().fixed) {
    const auto value = mechanism.default_value(parameters, fixed);
    if (!value) continue;
    auto& [from, to] = ranges_[static_cast<std::size_t>(fixed)];
    const double distance = reach * (to - from);
    from = std::max(*value - distance, std::min(from, *value));
    to = std::min(*value + distance, std::max(to, *value));
  }
}

Pose<double> SampledPoses::operator[](std::size_t index) const {
  Pose<double> pose(ranges_.size());
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const auto [from, to] = ranges_[i];
    pose[i] = from + (to - from) * halton(index, i);
  }
  return pose;
}

std::optional<Pose<double>> central_pose(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode) {
  constexpr std::size_t kTrials = 10'000, kEnough = 200;
  if (!mechanism.ranges(parameters)) return {};
  const SampledPoses poses(mechanism, parameters);
  std::vector<Pose<double>> feasible;
  Pose<double> mean(poses.ranges().size());
  for (std::size_t trial = 1; trial <= kTrials && feasible.size() < kEnough; ++trial) {
    const Pose<double> pose = poses[trial];
    if (!mechanism.inspect(parameters, pose, mode, limits).feasible) continue;
    feasible.push_back(pose);
    mean += pose;
  }
  const auto distance = [&](const Pose<double>& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < pose.size(); ++i)
      if (const double width = poses.ranges()[i][1] - poses.ranges()[i][0]; width > 0) {
        const double step = (pose[i] - mean[i] / static_cast<double>(feasible.size())) / width;
        sum += step * step;
      }
    return sum;
  };
  const auto closest = std::ranges::min_element(feasible, {}, distance);
  return closest == feasible.end() ? std::nullopt : std::optional(*closest);
}

}  // namespace pkm
