#include "experiments/app/stage_summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "engine/problem/order.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMostStarts = 12, kMostStartsOnFront = 20;  // that a table shows
/// Share of the greatest sensitivity below which one is what an optimum leaves of 0.
constexpr double kLeftByOptimum = 1e-6;

/// The starts, best end first; as they come where there are several objectives.
std::vector<std::size_t> by_end(const ProblemRecord& problem, const StageRecord& stage) {
  std::vector<std::size_t> order(stage.starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t start) {
    return ranked(problem.objectives, stage.table, static_cast<std::size_t>(stage.starts[start].end_row));
  };
  if (problem.objectives.size() == 1) std::ranges::stable_sort(order, better, rank);
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
/// this is an optimum: of several objectives there is no one optimum.
std::vector<std::size_t> optima(const ProblemRecord& problem, const StageRecord& stage) {
  std::vector<std::size_t> number_of(stage.starts.size(), 0), first;
  if (problem.objectives.size() > 1) return number_of;
  for (const std::size_t s : by_end(problem, stage)) {
    const StartOutcome& start = stage.starts[s];
    const bool feasible = stage.table.status[static_cast<std::size_t>(start.end_row)] == Status::feasible;
    const bool optimal = start.optimality < 1e-4;
    if (start.stop != words(StopReason::tolerance) || !feasible || !optimal) continue;
    const auto known = std::ranges::find_if(first, [&](std::size_t k) { return same_optimum(problem, stage, k, s); });
    number_of[s] = static_cast<std::size_t>(known - first.begin()) + 1;
    if (known == first.end()) first.push_back(s);
  }
  return number_of;
}

/// A start's objective, or each of several, at its beginning and at its end.
Row objectives_text(const StageRecord& stage, const StartOutcome& start) {
  const auto first = static_cast<std::size_t>(start.first_row), end = static_cast<std::size_t>(start.end_row);
  const auto from = stage.table.objective_row(first), to = stage.table.objective_row(end);
  const auto& status = stage.table.status;
  if (from.size() == 1) {
    const auto text = [&](std::size_t row, double value) {
      if (status[row] == Status::failed) return std::string("failed");
      return digits(value) + (status[row] == Status::feasible ? "" : " (infeasible)");
    };
    return {text(first, from[0]), text(end, to[0])};
  }
  Row texts(from.size(), "failed");
  for (std::size_t k = 0; status[first] != Status::failed && k < from.size(); ++k)
    texts[k] = formatted("%.6g", from[k]) + " -> " + formatted("%.6g", to[k]);
  return texts;
}

/// The records, unit by unit as they come; of a unit those first of which `size` makes most.
template <class Record, class Size>
std::vector<Record> greatest_first(std::vector<Record> records, const Size& size) {
  std::map<std::string, std::size_t> place;  // of a unit among the units
  for (const Record& r : records) place.try_emplace(r.unit, place.size());
  const auto key = [&](const Record& r) { return std::pair(place[r.unit], -std::fabs(size(r))); };
  std::ranges::stable_sort(records, std::less(), key);
  return records;
}

double influence(const SensitivityRecord& s) { return std::fmax(std::fabs(s.as_built), std::fabs(s.reoptimised)); }

/// Those that have an influence, with 0 where an optimum has left next to nothing of it, beside the greatest of the
/// unit.
std::vector<SensitivityRecord> without_remains(std::vector<SensitivityRecord> all) {
  std::erase_if(all, [](const SensitivityRecord& s) { return influence(s) == 0; });
  std::map<std::string, double> greatest;
  for (const SensitivityRecord& s : all) greatest[s.unit] = std::fmax(greatest[s.unit], influence(s));
  for (SensitivityRecord& s : all)
    for (double* const rate : {&s.as_built, &s.reoptimised})
      if (std::fabs(*rate) < kLeftByOptimum * greatest[s.unit]) *rate = 0;
  return all;
}

}  // namespace

std::string starts_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (stage.starts.empty()) return "";
  const bool one = problem.objectives.size() == 1;
  const auto order = by_end(problem, stage), optimum = optima(problem, stage);
  const std::size_t most = one ? kMostStarts : kMostStartsOnFront;
  std::vector<Row> rows = {{"  start", "evaluations"}};
  for (const ObjectiveInfo& o : problem.objectives) rows[0].push_back(o.name);
  if (one) rows[0].insert(rows[0].end(), {"to", "optimum"});
  rows[0].insert(rows[0].end(), {"optimality", "ended"});
  for (std::size_t k = 0; k < std::min(order.size(), most); ++k) {
    const StartOutcome& start = stage.starts[order[k]];
    const bool feasible = stage.table.status[static_cast<std::size_t>(start.end_row)] == Status::feasible;
    Row& row = rows.emplace_back(Row{"  " + start.origin, std::to_string(start.rows)});
    std::ranges::copy(objectives_text(stage, start), std::back_inserter(row));
    if (one) row.push_back(optimum[order[k]] ? std::to_string(optimum[order[k]]) : "-");
    row.push_back(formatted("%.1e", start.optimality));
    row.push_back(start.stop + (start.message.empty() ? "" : " (" + start.message + ")") +
                  (one || feasible ? "" : ", infeasible"));
  }
  const std::string more = "  and " + std::to_string(order.size() - rows.size() + 1) + " more";
  return aligned(rows) + (order.size() <= most ? "" : more + (one ? ", none better\n" : "\n"));
}

std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (!stage.optimality) return "";
  const OptimalityRecord& record = *stage.optimality;
  const ObjectiveInfo& objective = problem.objectives[0];
  const std::string of = objective.name + (objective.unit == "1" ? "" : " [" + objective.unit + "]");
  std::string text = "first-order optimality " + formatted("%.1e", record.optimality) + '\n';
  if (!record.active.empty()) {
    std::vector<Row> rows = {{"", "", "per", "multiplier"}};
    for (const ActiveRecord& a : greatest_first(record.active, [](const ActiveRecord& a) { return a.multiplier; }))
      rows.push_back({a.name, a.kind, handy(a.unit).unit, formatted("%.4g", a.multiplier * handy(a.unit).size)});
    text += titled("active, and the gain of " + of + " where it gives way", rows);
  }
  std::vector<Row> rows = {{"", "", "per", "as built", "reoptimised"}};
  for (const SensitivityRecord& s : greatest_first(without_remains(record.sensitivities), influence)) {
    const bool varies = std::isnan(s.reoptimised);
    const auto rate = [step = handy(s.unit).size](double value) {
      return value == 0 ? "0" : formatted("%+.4g", value * step);
    };
    rows.push_back({s.parameter, varies ? "varies" : "fixed", handy(s.unit).unit, rate(s.as_built),
                    varies ? "" : rate(s.reoptimised)});
  }
  return text + titled("sensitivity of " + of + ", of each unit the greatest first", rows) + '\n';
}

Json starts_json(const ProblemRecord& problem, const StageRecord& stage) {
  Json list = Json::array();
  const auto optimum = optima(problem, stage);
  const auto point = [&](std::int64_t row) {
    const auto r = static_cast<std::size_t>(row);
    Json json = row_json(problem, stage.table, r);
    json.erase("reports");
    json["feasible"] = stage.table.status[r] == Status::feasible;
    return json;
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
  const auto active = [](const ActiveRecord& a) -> Json {
    return {{"name", a.name}, {"kind", a.kind}, {"multiplier", a.multiplier}, {"unit", a.unit}};
  };
  const auto sensitivity = [](const SensitivityRecord& s) -> Json {
    return {{"parameter", s.parameter}, {"unit", s.unit}, {"as_built", s.as_built}, {"reoptimised", s.reoptimised}};
  };
  return {{"optimality", record.optimality},
          {"active", list_json(record.active, active)},
          {"sensitivities", list_json(record.sensitivities, sensitivity)}};
}

}  // namespace pkm
