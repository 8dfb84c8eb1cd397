#include "engine/problem/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pkm {
namespace {

std::vector<std::size_t> indices(const Scores& scores) {
  std::vector<std::size_t> all(scores.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// For each design, the sum of its scores.
std::vector<double> sums(const Scores& scores) {
  std::vector<double> result;
  for (std::size_t i = 0; i < scores.size(); ++i)
    result.push_back(std::accumulate(scores[i], scores[i] + scores.objectives, 0.0));
  return result;
}

/// Distance between two designs in the maximum norm.
double distance(const Scores& scores, std::size_t a, std::size_t b) {
  double largest = 0;
  for (std::size_t k = 0; k < scores.objectives; ++k)
    largest = std::max(largest, std::fabs(scores[a][k] - scores[b][k]));
  return largest;
}

}  // namespace

void add_scores(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table, std::size_t row,
                Scores& scores) {
  const auto values = table.objective_row(row);
  for (std::size_t k = 0; k < values.size(); ++k)
    scores.values.push_back(objectives[k].direction == Direction::maximise ? -values[k] : values[k]);
}

Scores scores_of(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table,
                 std::span<const std::int64_t> rows) {
  Scores scores{objectives.size()};
  for (const std::int64_t row : rows) add_scores(objectives, table, static_cast<std::size_t>(row), scores);
  return scores;
}

Ranges ranges_of(const Scores& front) {
  Ranges ranges;
  for (std::size_t k = 0; front.size() > 0 && k < front.objectives; ++k) {
    std::vector<double> column;
    for (std::size_t i = 0; i < front.size(); ++i) column.push_back(front[i][k]);
    ranges.minimum.push_back(std::ranges::min(column));
    ranges.maximum.push_back(std::ranges::max(column));
  }
  return ranges;
}

Scores normalised(const Scores& front) {
  const Ranges extent = ranges_of(front);
  Scores result = front;
  for (std::size_t i = 0; i < front.size(); ++i)
    for (std::size_t k = 0; k < front.objectives; ++k) {
      const double range = extent.range(k);
      result.values[i * front.objectives + k] = range > 0 ? (front[i][k] - extent.minimum[k]) / range : 0;
    }
  return result;
}

std::vector<std::size_t> ends_of(const Scores& front) {
  std::vector<std::size_t> ends;
  for (std::size_t k = 0; k < front.objectives; ++k)
    ends.push_back(std::ranges::min(indices(front), {}, [&](std::size_t i) { return front[i][k]; }));
  return ends;
}

std::size_t compromise(const Scores& front) {
  const Scores scaled = normalised(front);
  const std::vector<double> cost = sums(scaled);
  return std::ranges::min(indices(scaled), {}, [&](std::size_t i) {
    return std::pair(*std::max_element(scaled[i], scaled[i] + scaled.objectives), cost[i]);
  });
}

std::vector<std::size_t> knees(const Scores& front) {
  constexpr double kRadius = 0.2;  // radius of the neighbourhood of a design, in normalised scores
  constexpr double kMinGain =
      0.01;  // minimum cost advantage over the extreme points; excludes their neighbours and rounding effects
  // With fewer designs, most of them have no other design within kRadius.
  constexpr std::size_t kMinDesigns = 10;
  if (front.size() < kMinDesigns) return {};
  const Scores scaled = normalised(front);
  const Ranges extent = ranges_of(front);
  const std::vector<double> cost = sums(scaled);
  std::vector<std::size_t> order = indices(front), found;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
  double extreme_cost = std::numeric_limits<double>::infinity();  // minimum of the extreme points' costs
  for (std::size_t k = 0; k < front.objectives; ++k)
    for (std::size_t i = 0; i < front.size(); ++i)
      if (extent.range(k) > 0 && scaled[i][k] == 0) extreme_cost = std::min(extreme_cost, cost[i]);
  for (std::size_t i = 0; i < order.size() && cost[order[i]] < extreme_cost - kMinGain; ++i) {
    // Search the designs of lower cost in descending order of cost: those of similar cost are the most likely to be
    // within kRadius.
    const auto near = [&](std::size_t cheaper) { return distance(scaled, cheaper, order[i]) <= kRadius; };
    if (std::none_of(order.rend() - static_cast<std::ptrdiff_t>(i), order.rend(), near)) found.push_back(order[i]);
  }
  return found;
}

std::vector<std::size_t> select_representatives(const Scores& front, std::size_t count) {
  const std::size_t n = front.size();
  count = std::min(count, n);
  std::vector<std::size_t> chosen;
  if (count == 0) return chosen;
  const Scores scaled = normalised(front);
  // For each design, its distance to the nearest chosen design.
  std::vector<double> away(n, std::numeric_limits<double>::infinity());
  const auto choose = [&](std::size_t i) {
    if (chosen.size() == count || away[i] == 0) return;
    chosen.push_back(i);
    for (std::size_t j = 0; j < n; ++j) away[j] = std::min(away[j], distance(scaled, i, j));
  };
  choose(compromise(front));
  for (const std::size_t end : ends_of(front)) choose(end);
  while (chosen.size() < count) {
    const auto farthest = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
    if (away[farthest] == 0) break;
    choose(farthest);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace pkm
