#include "engine/problem/built_machines.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/math/random.hpp"

namespace pkm {

void ToleranceModel::sample(std::size_t index, std::span<const double> design, std::vector<double>& parameters) const {
  parameters.assign(design.begin(), design.end());
  parameters.resize(design.size() + copies.size());
  for (const auto& [own, common] : copies) parameters[own] = design[common];
  Stream stream(seed, 0, static_cast<std::uint32_t>(index), Stream::Use::tolerance);
  std::vector<double> normal, drawn;
  for (const ErrorGroup& group : groups) {
    const ParameterError& first = errors[group.errors.front()];
    if (first.sigma == 0) {
      parameters[first.parameter] += first.bound * (2 * stream.u01() - 1);
      continue;
    }
    const std::size_t count = group.errors.size();
    normal.resize(count);
    drawn.resize(count);
    // Sample the truncated distribution by rejection: draw the errors of a group until all of them are within their
    // bounds.
    const auto is_within = [&] {
      for (std::size_t i = 0; i < count; ++i)
        if (!(std::fabs(drawn[i]) <= errors[group.errors[i]].bound)) return false;
      return true;
    };
    do {
      for (double& each : normal) each = stream.normal();
      for (std::size_t i = 0; i < count; ++i) {
        double sum = count == 1 ? normal[0] : 0;
        for (std::size_t k = 0; count > 1 && k <= i; ++k) sum += group.factor[i][k] * normal[k];
        drawn[i] = errors[group.errors[i]].sigma * sum;
      }
    } while (!is_within());
    for (std::size_t i = 0; i < count; ++i) parameters[errors[group.errors[i]].parameter] += drawn[i];
  }
}

std::array<double, 2> Yield::interval() const {
  constexpr double z = 1.959963984540054;  // 0.975 quantile of the normal distribution
  const auto n = static_cast<double>(machines);
  const double scale = 1 / (1 + z * z / n), centre = scale * (share() + z * z / (2 * n));
  const double half = scale * z * std::sqrt(share() * (1 - share()) / n + z * z / (4 * n * n));
  return {good == 0 ? 0 : centre - half, good == machines ? 1 : centre + half};
}

std::vector<std::pair<std::size_t, double>> sample_weights(const SampledValue& sampled,
                                                           std::span<const double> values) {
  using Statistic = SampledValue::Statistic;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isnan(values[i])) return {{i, 1.0}};
  const std::size_t count = values.size();
  std::vector<std::pair<std::size_t, double>> weights;
  if (sampled.statistic == Statistic::mean) {
    for (std::size_t i = 0; i < count; ++i) weights.emplace_back(i, 1 / static_cast<double>(count));
    return weights;
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto is_worse = [&](std::size_t a, std::size_t b) {
    if (values[a] == values[b]) return a < b;
    return sampled.greater_is_better == (values[a] < values[b]);
  };
  if (sampled.statistic == Statistic::worst) return {{*std::ranges::min_element(order, is_worse), 1.0}};
  std::ranges::sort(order, is_worse);
  const double position = sampled.probability * static_cast<double>(count - 1);
  const auto below = std::min(static_cast<std::size_t>(position), count - 1);
  const double rest = position - static_cast<double>(below);
  weights.emplace_back(order[below], 1 - rest);
  if (rest > 0) weights.emplace_back(order[below + 1], rest);
  return weights;
}

Yield yield_of(const MachineValues& values) {
  const std::size_t width = values.margins.size() / values.machines;
  Yield yield{.machines = values.machines, .violated = std::vector<std::size_t>(width)};
  for (std::size_t machine = 0; machine < values.machines; ++machine) {
    bool is_good = true, is_violated = false;
    for (std::size_t k = 0; k < width; ++k) {
      const double margin = values.margins[machine * width + k];
      is_good = is_good && margin >= 0;
      is_violated = is_violated || margin < 0;
      yield.violated[k] += margin < 0;
    }
    yield.good += is_good;
    yield.failed += !is_good && !is_violated;
  }
  return yield;
}

double yield_statistic(const SampledValue& sampled, const Yield& yield) {
  if (sampled.statistic == SampledValue::Statistic::yield) return yield.share();
  return yield.interval()[sampled.statistic == SampledValue::Statistic::yield_lower ? 0 : 1];
}

}  // namespace pkm
