#include "engine/mechanism/central_pose.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/math/halton.hpp"

namespace pkm {

std::optional<Pose<double>> central_pose(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode) {
  constexpr std::size_t kTrials = 10'000, kEnough = 200;
  auto ranges = mechanism.ranges(parameters);
  if (!ranges) return {};
  for (const int fixed : mechanism.info().sweeps.front().fixed)
    if (const auto value = mechanism.default_value(parameters, fixed))
      (*ranges)[static_cast<std::size_t>(fixed)] = {*value, *value};
  const std::size_t n = ranges->size();
  std::vector<Pose<double>> feasible;
  Pose<double> mean(n);
  for (std::size_t trial = 1; trial <= kTrials && feasible.size() < kEnough; ++trial) {
    Pose<double> pose(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto [from, to] = (*ranges)[i];
      pose[i] = from + (to - from) * halton(trial, i);
    }
    if (!mechanism.inspect(parameters, pose, mode, limits).feasible) continue;
    feasible.push_back(pose);
    mean += pose;
  }
  const auto distance = [&](const Pose<double>& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (const double width = (*ranges)[i][1] - (*ranges)[i][0]; width > 0) {
        const double step = (pose[i] - mean[i] / static_cast<double>(feasible.size())) / width;
        sum += step * step;
      }
    return sum;
  };
  const auto closest = std::ranges::min_element(feasible, {}, distance);
  return closest == feasible.end() ? std::nullopt : std::optional(*closest);
}

}  // namespace pkm
