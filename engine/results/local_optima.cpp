#include "engine/results/local_optima.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

/// Whether the final designs of two multistart runs are the same optimum: equal in every variable to 1/1000 of its
/// range.
bool same_optimum(const ProblemRecord& problem, const StageRecord& stage, std::size_t a, std::size_t b) {
  const auto p = stage.table.design(static_cast<std::size_t>(stage.starts[a].end_row));
  const auto q = stage.table.design(static_cast<std::size_t>(stage.starts[b].end_row));
  for (std::size_t v = 0; v < p.size(); ++v)
    if (std::fabs(p[v] - q[v]) > 1e-3 * (problem.variables[v].upper - problem.variables[v].lower)) return false;
  return true;
}

}  // namespace

std::vector<std::size_t> order_by_result(const ProblemRecord& problem, const StageRecord& stage) {
  std::vector<std::size_t> order(stage.starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t start) {
    return ranked(problem.objectives, stage.table, static_cast<std::size_t>(stage.starts[start].end_row));
  };
  if (problem.objectives.size() == 1) std::ranges::stable_sort(order, better, rank);
  return order;
}

std::vector<std::size_t> number_optima(const ProblemRecord& problem, const StageRecord& stage) {
  std::vector<std::size_t> number(stage.starts.size(), 0), first;
  if (problem.objectives.size() > 1) return number;
  for (const std::size_t s : order_by_result(problem, stage)) {
    const StartOutcome& start = stage.starts[s];
    const bool feasible = stage.table.status[static_cast<std::size_t>(start.end_row)] == Status::feasible;
    const bool optimal = start.optimality < 1e-4;
    if (start.stop != words(StopReason::tolerance) || !feasible || !optimal) continue;
    const auto known = std::ranges::find_if(first, [&](std::size_t k) { return same_optimum(problem, stage, k, s); });
    number[s] = static_cast<std::size_t>(known - first.begin()) + 1;
    if (known == first.end()) first.push_back(s);
  }
  return number;
}

}  // namespace pkm
