// The Pareto front of a stage as a text table and as JSON.
#include "experiments/app/stage_summary.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/results/design_values.hpp"
#include "engine/results/front_points.hpp"

namespace pkm {
namespace {

// A front of at most kMaxFullFront points is shown completely; of a larger one, kExcerptSize well-spread points and all
// points with a label are shown.
constexpr std::size_t kMaxFullFront = 20, kExcerptSize = 10;

std::string headline(const ProblemRecord& problem, const StageRecord& stage, const Scores& front) {
  const FrontRecord& record = *stage.front;
  std::string text = "  front: " + std::to_string(front.size()) + (front.size() == 1 ? " design" : " designs");
  if (!record.reference.empty()) {
    text += ", hypervolume " + digits(hypervolume_of(problem, stage, front)) + " with reference point";
    for (std::size_t k = 0; k < record.reference.size(); ++k)
      text += (k ? ", " : " ") + problem.objectives[k].name + " " +
              result_text(record.reference[k], problem.objectives[k].unit);
  }
  if (!record.spread.empty() && !std::isnan(record.spread.back())) text += "; spread " + digits(record.spread.back());
  if (!record.igd_plus.empty() && !std::isnan(record.igd_plus.back()))
    text += "; IGD+ " + digits(record.igd_plus.back());
  return text + '\n';
}

}  // namespace

std::string front_text(const ProblemRecord& problem, const StageRecord& stage) {
  if (!stage.front || stage.front->rows.empty()) return "";
  const Scores front = scores_of(problem.objectives, stage.table, stage.front->rows);
  const auto labels = point_labels(problem, front);
  const std::vector<std::size_t> spread =
      select_representatives(front, front.size() <= kMaxFullFront ? kMaxFullFront : kExcerptSize);
  std::vector<Row> rows = {{"  point"}};
  // Each column has the unit that suits its largest value.
  const auto unit_of = [&](const auto& named, const auto& values_of, const auto& choose_unit) {
    double greatest = 0;
    for (const std::int64_t row : stage.front->rows)
      greatest = std::fmax(greatest, std::fabs(values_of(static_cast<std::size_t>(row))));
    const DisplayUnit unit = choose_unit(named.unit, greatest);
    rows[0].push_back(named.name + (unit.name == "1" ? "" : " [" + unit.name + "]"));
    return unit;
  };
  std::vector<DisplayUnit> units, units_of_objectives;
  for (std::size_t v = 0; v < problem.variables.size(); ++v)
    units.push_back(unit_of(
        problem.variables[v], [&](std::size_t row) { return stage.table.design(row)[v]; },
        [](std::string_view unit, double size) { return display_unit(unit, size); }));
  for (std::size_t k = 0; k < problem.objectives.size(); ++k)
    units_of_objectives.push_back(unit_of(
        problem.objectives[k], [&](std::size_t row) { return stage.table.objective_row(row)[k]; }, result_unit));
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (labels[i].empty() && std::ranges::find(spread, i) == spread.end()) continue;
    const auto row = static_cast<std::size_t>(stage.front->rows[i]);
    Row& cells = rows.emplace_back(Row{"  " + std::to_string(i + 1)});
    for (std::size_t v = 0; v < problem.variables.size(); ++v)
      cells.push_back(variable_text(problem, v, stage.table.design(row)[v], units[v]));
    for (std::size_t k = 0; k < problem.objectives.size(); ++k)
      cells.push_back(digits(stage.table.objective_row(row)[k] / units_of_objectives[k].size));
    cells.push_back(join(labels[i]));
  }
  return headline(problem, stage, front) + aligned(rows);
}

std::string variable_text(const ProblemRecord& problem, std::size_t variable, double value) {
  const std::string name = choice_name(problem, variable, value);
  return name.empty() ? number(value, problem.variables[variable].unit) : name;
}

std::string variable_text(const ProblemRecord& problem, std::size_t variable, double value, const DisplayUnit& unit) {
  const std::string name = choice_name(problem, variable, value);
  return name.empty() ? digits(value / unit.size) : name;
}

Json variable_json(const ProblemRecord& problem, std::size_t variable, double value) {
  const std::string name = choice_name(problem, variable, value);
  return name.empty() ? Json(value) : Json(name);
}

Json row_json(const ProblemRecord& problem, const EvaluationTable& table, std::size_t row) {
  Json design = Json::object();
  for (std::size_t v = 0; v < problem.variables.size(); ++v)
    design[problem.variables[v].name] = variable_json(problem, v, table.design(row)[v]);
  return {{"design", design},
          {"objectives", values_by_name(problem.objectives, table.objective_row(row))},
          {"constraints", values_by_name(problem.margins, table.margin_row(row))},
          {"outputs", values_by_name(problem.reports, table.output_row(row))}};
}

Json front_json(const ProblemRecord& problem, const StageRecord& stage) {
  const FrontRecord& record = *stage.front;
  const Scores front = scores_of(problem.objectives, stage.table, stage.front->rows);
  Json json = {
      {"reference", record.reference.empty() ? Json() : values_by_name(problem.objectives, record.reference)},
      {"hypervolume", Json()},
      {"points", Json::array()},
      {"generations", {{"hypervolume", record.hypervolume}, {"spread", record.spread}, {"igd_plus", record.igd_plus}}}};
  if (front.size() == 0) return json;
  const double volume = hypervolume_of(problem, stage, front);
  if (std::isfinite(volume)) json["hypervolume"] = volume;
  const auto labels = point_labels(problem, front);
  for (std::size_t i = 0; i < front.size(); ++i) {
    Json point = {{"point", i + 1}, {"evaluation", record.rows[i]}};
    point.update(row_json(problem, stage.table, static_cast<std::size_t>(record.rows[i])));
    point["marks"] = labels[i];
    json["points"].push_back(point);
  }
  return json;
}

}  // namespace pkm
