#include "experiments/app/stage_summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "engine/results/local_optima.hpp"

namespace pkm {
namespace {

// Maximum number of rows of the table of multistart runs, without and with a front.
constexpr std::size_t kMaxStarts = 12, kMaxStartsOnFront = 20;
/// Sensitivities that are smaller than this, relative to the largest one of the same unit, are regarded as zero: they
/// are due to the solver's incomplete convergence.
constexpr double kZeroSensitivity = 1e-6;

/// Table cells with the objective of a multistart run at its first and at its last design: two cells or, with several
/// objectives, one cell for each of them.
Row objective_cells(const ProblemRecord& problem, const StageRecord& stage, const StartOutcome& start) {
  const auto first = static_cast<std::size_t>(start.first_row), end = static_cast<std::size_t>(start.end_row);
  const auto from = stage.table.objective_row(first), to = stage.table.objective_row(end);
  const auto& status = stage.table.status;
  const auto value_text = [&](std::size_t k, double value) { return result_text(value, problem.objectives[k].unit); };
  if (from.size() == 1) {
    const auto text = [&](std::size_t row, double value) {
      if (status[row] == Status::failed) return std::string("failed");
      return value_text(0, value) + (status[row] == Status::feasible ? "" : " (infeasible)");
    };
    return {text(first, from[0]), text(end, to[0])};
  }
  Row texts(from.size(), "failed");
  for (std::size_t k = 0; status[first] != Status::failed && k < from.size(); ++k)
    texts[k] = value_text(k, from[k]) + " -> " + value_text(k, to[k]);
  return texts;
}

/// Groups records by unit, in the order in which the units appear, and sorts each group by decreasing |value(record)|.
template <class Record, class Value>
std::vector<Record> sorted_within_units(std::vector<Record> records, const Value& value) {
  std::map<std::string, std::size_t> group;  // for each unit, the index of its group
  for (const Record& r : records) group.try_emplace(r.unit, group.size());
  const auto key = [&](const Record& r) { return std::pair(group[r.unit], -std::fabs(value(r))); };
  std::ranges::stable_sort(records, std::less(), key);
  return records;
}

double influence(const SensitivityRecord& s) { return std::fmax(std::fabs(s.as_built), std::fabs(s.reoptimised)); }

/// Removes parameters without influence, and sets those derivatives to 0 that are negligible compared with the largest
/// one of the same unit. Derivatives that vanish at the exact optimum are not exactly 0 at the design where the solver
/// stopped.
std::vector<SensitivityRecord> without_residuals(std::vector<SensitivityRecord> all) {
  std::erase_if(all, [](const SensitivityRecord& s) { return influence(s) == 0; });
  std::map<std::string, double> largest;
  for (const SensitivityRecord& s : all) largest[s.unit] = std::fmax(largest[s.unit], influence(s));
  for (SensitivityRecord& s : all)
    for (double* const value : {&s.as_built, &s.reoptimised})
      if (std::fabs(*value) < kZeroSensitivity * largest[s.unit]) *value = 0;
  return all;
}

}  // namespace

std::string starts_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (stage.starts.empty()) return "";
  const bool one = problem.objectives.size() == 1;
  const auto order = order_by_result(problem, stage), optimum = number_optima(problem, stage);
  const std::size_t max_rows = one ? kMaxStarts : kMaxStartsOnFront;
  std::vector<Row> rows = {{"  start", "evaluations"}};
  for (const ObjectiveInfo& o : problem.objectives) rows[0].push_back(o.name);
  if (one) rows[0].insert(rows[0].end(), {"to", "optimum"});
  rows[0].insert(rows[0].end(), {"KKT residual", "ended"});
  for (std::size_t k = 0; k < std::min(order.size(), max_rows); ++k) {
    const StartOutcome& start = stage.starts[order[k]];
    const bool feasible = stage.table.status[static_cast<std::size_t>(start.end_row)] == Status::feasible;
    Row& row = rows.emplace_back(Row{"  " + start.origin, std::to_string(start.rows)});
    std::ranges::copy(objective_cells(problem, stage, start), std::back_inserter(row));
    if (one) row.push_back(optimum[order[k]] ? std::to_string(optimum[order[k]]) : "-");
    row.push_back(formatted("%.1e", start.optimality));
    row.push_back(start.stop + (start.message.empty() ? "" : " (" + start.message + ")") +
                  (one || feasible ? "" : ", infeasible"));
  }
  const std::string more = "  and " + std::to_string(order.size() - rows.size() + 1) + " more";
  const bool is_known = std::ranges::any_of(stage.starts, [](const auto& s) { return std::isfinite(s.optimality); });
  return aligned(rows) + (order.size() <= max_rows ? "" : more + (one ? ", none better\n" : "\n")) +
         (is_known && one ? "    optimum: number of the local optimum reached; - if none was reached\n" : "") +
         (is_known ? "    KKT residual: relative improvement per full range of a variable, to first order; below " +
                         shortest(kMaxResidualOfOptimum) + " at an optimum\n"
                   : "");
}

std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (!stage.optimality) return "";
  const OptimalityRecord& record = *stage.optimality;
  const ObjectiveInfo& objective = problem.objectives[0];
  // Rates have the unit in which the objective of the stage's best design is printed.
  const double best = stage.best_row < 0 ? 1 : stage.table.objective_row(static_cast<std::size_t>(stage.best_row))[0];
  const auto [size, unit] = result_unit(objective.unit, best);
  const auto rate = [size = size](double value, const std::string& per) {
    return value * display_unit(per).size / size;
  };
  const std::string of = objective.name + (unit == "1" ? "" : " [" + unit + "]");
  std::string text = "first-order optimality (KKT residual) " + formatted("%.1e", record.optimality) + "; below " +
                     shortest(kMaxResidualOfOptimum) + " at an optimum\n";
  if (!record.active.empty()) {
    std::vector<Row> rows = {{"", "", "per unit", "multiplier"}};
    for (const ActiveRecord& a : sorted_within_units(record.active, [](const ActiveRecord& a) { return a.multiplier; }))
      rows.push_back({a.name, a.kind, display_unit(a.unit).name, digits(rate(a.multiplier, a.unit))});
    text += format_titled_table("active constraints, and the gain of " + of + " if they are relaxed", rows);
  }
  std::vector<Row> rows = {{"", "", "per unit", "others fixed", "reoptimised"}};
  for (const SensitivityRecord& s : sorted_within_units(without_residuals(record.sensitivities), influence)) {
    const bool varies = std::isnan(s.reoptimised);
    const auto text_of = [&](double value) { return value == 0 ? "0" : signed_digits(rate(value, s.unit)); };
    rows.push_back({s.parameter, varies ? "varies" : "fixed", display_unit(s.unit).name, text_of(s.as_built),
                    varies ? "" : text_of(s.reoptimised)});
  }
  return text + format_titled_table("sensitivity of " + of + ", largest first within each unit", rows) + '\n';
}

Json starts_json(const ProblemRecord& problem, const StageRecord& stage) {
  Json list = Json::array();
  const auto optimum = number_optima(problem, stage);
  const auto point = [&](std::int64_t row) {
    const auto r = static_cast<std::size_t>(row);
    Json json = row_json(problem, stage.table, r);
    json.erase("outputs");
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
