#include "engine/results/local_optima.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

/// Returns true if the derivative of the objective with respect to a variable is exactly 0 at the best design. With
/// respect to a variable that has an influence, the derivative at an optimum is small, but not 0, due to rounding.
bool has_no_influence(const StageRecord& stage, const std::string& variable) {
  if (!stage.optimality) return false;
  const auto& all = stage.optimality->sensitivities;
  const auto found = std::ranges::find(all, variable, &SensitivityRecord::parameter);
  return found != all.end() && found->as_built == 0;
}

/// Whether the final designs of two starts are the same optimum, see number_optima().
bool same_optimum(const ProblemRecord& problem, const StageRecord& stage, std::size_t a, std::size_t b) {
  constexpr double kTolerance = 1e-3, kSameObjective = 1e-6;  // relative to the range, relative to the objective
  const auto row = [&](std::size_t start) { return static_cast<std::size_t>(stage.starts[start].end_row); };
  const auto p = stage.table.design(row(a)), q = stage.table.design(row(b));
  const double f = stage.table.objective_row(row(a))[0], g = stage.table.objective_row(row(b))[0];
  const bool same_objective = std::fabs(f - g) <= kSameObjective * std::fabs(f);
  for (std::size_t v = 0; v < p.size(); ++v) {
    const Variable& variable = problem.variables[v];
    if (std::fabs(p[v] - q[v]) <= kTolerance * (variable.upper - variable.lower)) continue;
    if (!same_objective || !has_no_influence(stage, variable.name)) return false;
  }
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
    const bool optimal = start.optimality < kMaxResidualOfOptimum;
    if (start.stop != words(StopReason::tolerance) || !feasible || !optimal) continue;
    const auto known = std::ranges::find_if(first, [&](std::size_t k) { return same_optimum(problem, stage, k, s); });
    number[s] = static_cast<std::size_t>(known - first.begin()) + 1;
    if (known == first.end()) first.push_back(s);
  }
  return number;
}

}  // namespace pkm
