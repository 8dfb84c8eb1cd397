#include "experiments/app/solver_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/text_table.hpp"
#include "engine/problem/order.hpp"
#include "experiments/app/front_summary.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMostStarts = 12;  // that a table shows

/// "3.47 rad/m" -> per mm for lengths, per degree for angles: what an engineer thinks in.
struct Step {
  double size;
  std::string unit;
};
Step handy(const std::string& unit) {
  if (unit == "m") return {1e-3, "mm"};
  if (unit == "rad") return {3.14159265358979323846 / 180, "deg"};
  return {1, unit};
}

/// The starts, best end first.
std::vector<std::size_t> by_end(const ProblemRecord& problem, const StageRecord& stage) {
  std::vector<std::size_t> order(stage.starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto rank = [&](std::size_t start) {
      return ranked(problem.objectives, stage.table, static_cast<std::size_t>(stage.starts[start].end_row));
    };
    return better(rank(a), rank(b));
  });
  return order;
}

/// Whether two ends are the same optimum: alike in every variable to a thousandth of its range.
bool same_optimum(const ProblemRecord& problem, const StageRecord& stage, std::size_t a, std::size_t b) {
  const auto p = stage.table.design(static_cast<std::size_t>(stage.starts[a].end_row));
  const auto q = stage.table.design(static_cast<std::size_t>(stage.starts[b].end_row));
  for (std::size_t v = 0; v < p.size(); ++v)
    if (std::fabs(p[v] - q[v]) > 1e-3 * (problem.variables[v].upper - problem.variables[v].lower)) return false;
  return true;
}

/// Number of the optimum in which each start ended, 1 for the best; 0 where it has not converged or nothing says that
/// this is an optimum.
std::vector<std::size_t> optima(const ProblemRecord& problem, const StageRecord& stage,
                                const std::vector<std::size_t>& order) {
  std::vector<std::size_t> number_of(stage.starts.size(), 0), first;
  for (const std::size_t s : order) {
    const StartOutcome& start = stage.starts[s];
    const bool feasible = stage.table.status[static_cast<std::size_t>(start.end_row)] == Status::feasible;
    const bool optimal = start.optimality < 1e-4;
    if (start.stop != words(StopReason::tolerance) || !feasible || !optimal) continue;
    std::size_t k = 0;
    while (k < first.size() && !same_optimum(problem, stage, first[k], s)) ++k;
    if (k == first.size()) first.push_back(s);
    number_of[s] = k + 1;
  }
  return number_of;
}

std::string objective_at(const StageRecord& stage, std::int64_t row) {
  const auto r = static_cast<std::size_t>(row);
  if (stage.table.status[r] == Status::failed) return "failed";
  const std::string value = formatted("%.10g", stage.table.objective_row(r)[0]);
  return stage.table.status[r] == Status::feasible ? value : value + " (infeasible)";
}

}  // namespace

std::string starts_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (stage.starts.empty()) return "";
  if (problem.objectives.size() > 1) return front_starts_text(problem, stage);
  const auto order = by_end(problem, stage);
  const auto optimum = optima(problem, stage, order);
  std::vector<std::vector<std::string>> rows = {
      {"  start", "evaluations", problem.objectives[0].name, "to", "optimum", "optimality", "ended"}};
  for (std::size_t k = 0; k < std::min(order.size(), kMostStarts); ++k) {
    const StartOutcome& start = stage.starts[order[k]];
    rows.push_back({"  " + start.origin, std::to_string(start.rows), objective_at(stage, start.first_row),
                    objective_at(stage, start.end_row), optimum[order[k]] ? std::to_string(optimum[order[k]]) : "-",
                    formatted("%.1e", start.optimality),
                    start.stop + (start.message.empty() ? "" : " (" + start.message + ")")});
  }
  std::string text = aligned(rows);
  if (order.size() > kMostStarts)
    text += "  and " + std::to_string(order.size() - kMostStarts) + " more, none better\n";
  return text;
}

std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (!stage.optimality) return "";
  const OptimalityRecord& record = *stage.optimality;
  const ObjectiveInfo& objective = problem.objectives[0];
  std::string text = "first-order optimality " + formatted("%.1e", record.optimality) + '\n';
  std::vector<std::vector<std::string>> rows = {{"active", "", "multiplier", ""}};
  for (const ActiveRecord& a : record.active) {
    const Step step = handy(a.unit);
    rows.push_back({a.name, a.kind, formatted("%.4g", a.multiplier * step.size),
                    objective.unit + (step.unit == "1" ? "" : " per " + step.unit)});
  }
  if (rows.size() > 1) text += '\n' + aligned(rows);
  rows = {{"sensitivity", "", "as built", "reoptimised", ""}};
  for (const SensitivityRecord& s : record.sensitivities) {
    if (s.as_built == 0 && !(s.reoptimised != 0)) continue;  // has no influence
    const Step step = handy(s.unit);
    rows.push_back({s.parameter, std::isnan(s.reoptimised) ? "varies" : "fixed",
                    formatted("%+.4g", s.as_built * step.size),
                    std::isnan(s.reoptimised) ? "" : formatted("%+.4g", s.reoptimised * step.size),
                    objective.unit + (step.unit == "1" ? "" : " per " + step.unit)});
  }
  return text + '\n' + aligned(rows);
}

Json starts_json(const ProblemRecord& problem, const StageRecord& stage) {
  Json list = Json::array();
  const bool one = problem.objectives.size() == 1;  // of several there is no one optimum
  const auto optimum =
      one ? optima(problem, stage, by_end(problem, stage)) : std::vector<std::size_t>(stage.starts.size(), 0);
  const auto point = [&](std::int64_t row) {
    const auto r = static_cast<std::size_t>(row);
    return Json{{"design", values_by_name(problem.variables, stage.table.design(r))},
                {"objectives", values_by_name(problem.objectives, stage.table.objective_row(r))},
                {"constraints", values_by_name(problem.margins, stage.table.margin_row(r))},
                {"feasible", stage.table.status[r] == Status::feasible}};
  };
  for (std::size_t s = 0; s < stage.starts.size(); ++s) {
    const StartOutcome& start = stage.starts[s];
    list.push_back({{"origin", start.origin},
                    {"evaluations", start.rows},
                    {"start", point(start.first_row)},
                    {"end", point(start.end_row)},
                    {"optimum", optimum[s] ? Json(optimum[s]) : Json()},
                    {"optimality", start.optimality},
                    {"stop", start.stop},
                    {"message", start.message}});
  }
  return list;
}

Json optimality_json(const OptimalityRecord& record) {
  Json json = {{"optimality", record.optimality}, {"active", Json::array()}, {"sensitivities", Json::array()}};
  for (const ActiveRecord& a : record.active)
    json["active"].push_back({{"name", a.name}, {"kind", a.kind}, {"multiplier", a.multiplier}, {"unit", a.unit}});
  for (const SensitivityRecord& s : record.sensitivities)
    json["sensitivities"].push_back({{"parameter", s.parameter},
                                     {"unit", s.unit},
                                     {"as_built", finite(s.as_built)},
                                     {"reoptimised", s.reoptimised}});
  return json;
}

}  // namespace pkm
