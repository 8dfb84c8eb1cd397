#include <array>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "engine/report/json_text.hpp"
#include "engine/report/sections.hpp"
#include "engine/report/standing.hpp"

namespace pkm {
namespace {

using Json = nlohmann::ordered_json;
using Found = std::optional<DesignRecord>;

/// A design of the table: "best", and the same on exact columns where there are both.
struct Column {
  std::string name;
  Found record, exact;
};

std::vector<Column> columns(const StudyContents& contents) {
  if (!contents.final || !contents.final->best) return {{"best so far", best_so_far(contents), {}}};
  const FinalRecord& final = *contents.final;
  std::vector<Column> list = {
      {contents.problem.objectives.size() > 1 ? "compromise" : "best", final.best, final.best_exact}};
  if (final.rounded) list.push_back({"rounded", final.rounded, {}});
  if (final.baseline) list.push_back({"baseline", final.baseline, final.baseline_exact});
  return list;
}

/// The best and the baseline among the columns; the latter may be missing.
const Column* baseline_of(const std::vector<Column>& list) {
  return list.back().name == "baseline" ? &list.back() : nullptr;
}

struct Table {
  const PageStudy& page;
  std::vector<Column> list = columns(page.contents);
  Json rows = Json::array();

  /// A row of one value per column, then of the references; nothing where no design has the value.
  void add(const std::string& kind, const std::string& name, const std::string& unit, const std::string& meaning,
           std::optional<Direction> direction, bool exact, const std::function<double(const DesignRecord&)>& of,
           const std::function<std::optional<double>(const Reference&)>& reference = {}) {
    Json values = Json::array();
    const auto value = [&](const Column& column) -> std::optional<double> {
      const Found& record = exact ? column.exact : column.record;
      return record ? std::optional(of(*record)) : std::nullopt;
    };
    const auto push = [&](std::optional<double> number) { values.push_back(number ? Json(*number) : Json()); };
    for (const Column& column : list) push(value(column));
    if (page.study)
      for (const Reference& r : page.study->references) push(reference && !exact ? reference(r) : std::nullopt);
    Json row = {{"kind", kind}, {"name", name}, {"unit", unit}, {"meaning", meaning}, {"values", values}};
    const Column* const baseline = baseline_of(list);
    if (direction && baseline && value(list[0]) && value(*baseline))
      if (const auto gain = gain_over(*value(*baseline), *value(list[0]), *direction))
        row["gain"] = {{"percent", gain->percent}, {"worse", gain->worse}};
    rows.push_back(row);
  }
};

std::optional<double> value_of_reference(const Reference& reference, const std::string& name) {
  for (const auto& [key, value] : reference.values)
    if (key == name) return value;
  return {};
}

Json table(const PageStudy& page) {
  const ProblemRecord& problem = page.contents.problem;
  Table table{page};
  if (!table.list[0].record) return Json();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const ParameterRecord& p = problem.parameters[i];
    if (p.variable < 0) continue;
    const auto variable = static_cast<std::size_t>(p.variable);
    table.add(
        "variable", p.name, p.unit, "", {}, false, [i](const DesignRecord& r) { return r.parameters[i]; },
        [variable](const Reference& r) { return r.design.empty() ? std::nullopt : r.design[variable]; });
  }
  const auto add = [&](const char* kind, const auto& info, std::optional<Direction> direction, const auto& of) {
    const auto reference = [&info](const Reference& r) { return value_of_reference(r, info.name); };
    table.add(kind, info.name, info.unit, info.meaning, direction, false, of, reference);
    if (table.list[0].exact) table.add(kind, info.name + ", exact", info.unit, info.meaning, direction, true, of);
  };
  for (std::size_t i = 0; i < problem.objectives.size(); ++i)
    add("objective", problem.objectives[i], problem.objectives[i].direction,
        [i](const DesignRecord& r) { return r.objectives[i]; });
  for (std::size_t i = 0; i < problem.reports.size(); ++i)
    add("report", problem.reports[i], {}, [i](const DesignRecord& r) { return r.reports[i]; });
  for (std::size_t i = 0; i < problem.margins.size(); ++i)
    table.add("constraint", problem.margins[i].name, problem.margins[i].unit, problem.margins[i].meaning, {}, false,
              [i](const DesignRecord& r) { return r.margins[i]; });

  Json heads = Json::array();
  for (const Column& column : table.list)
    heads.push_back({{"name", column.name},
                     {"status", words(column.record->status)},
                     {"reason", column.record->reason},
                     {"reference", false}});
  if (page.study)
    for (const Reference& r : page.study->references)
      heads.push_back({{"name", r.name}, {"seconds", r.seconds ? Json(*r.seconds) : Json()}, {"reference", true}});
  return {{"columns", heads}, {"rows", table.rows}};
}

/// Where the time went: wall time, time of the evaluations, and the evaluations by how they ended.
Json stages(const StudyContents& contents) {
  Json list = Json::array();
  double begin = 0;
  for (const StageRecord& stage : contents.stages) {
    const double end = stage.generations.size() ? stage.generations.seconds.back() : begin;
    double evaluating = 0;
    for (const float seconds : stage.table.seconds) evaluating += static_cast<double>(seconds);
    std::array<std::int64_t, 4> count{};
    for (const Status status : stage.table.status) ++count[static_cast<std::size_t>(status)];
    Json outcomes = Json::object();
    for (std::size_t k = 0; k < count.size(); ++k) outcomes[words(static_cast<Status>(k))] = count[k];
    list.push_back({{"optimiser", stage.optimiser},
                    {"options", stage.options},
                    {"generations", stage.generations.size()},
                    {"evaluations", stage.table.size()},
                    {"starts", stage.starts.size()},
                    {"outcomes", outcomes},
                    {"finished", stage.finished},
                    {"stop", stage.stop},
                    {"seconds", end - begin},
                    {"evaluating", evaluating}});
    begin = end;
  }
  return list;
}

/// First-order optimality of the best design: of the stage that found it, else of the last.
Json optimality(const StudyContents& contents) {
  if (contents.best.row < 0) return Json();
  const StageRecord& of_best = contents.stages[static_cast<std::size_t>(contents.best.stage)];
  const auto& record = of_best.optimality ? of_best.optimality : contents.stages.back().optimality;
  if (!record) return Json();
  Json json = {{"optimality", record->optimality}, {"active", Json::array()}, {"sensitivities", Json::array()}};
  for (const ActiveRecord& a : record->active)
    json["active"].push_back({{"name", a.name}, {"kind", a.kind}, {"multiplier", a.multiplier}, {"unit", a.unit}});
  for (const SensitivityRecord& s : record->sensitivities)
    json["sensitivities"].push_back(
        {{"name", s.parameter}, {"unit", s.unit}, {"as_built", s.as_built}, {"reoptimised", s.reoptimised}});
  return json;
}

/// What somebody needs to run the study again.
Json origin(const PageStudy& page) {
  const StudyContents& c = page.contents;
  Json extensions = Json::array();
  for (const Extension& e : c.extensions)
    extensions.push_back({{"stage", e.stage + 1}, {"limit", e.limit}, {"value", e.value}});
  return {{"toml_file", c.toml_file},
          {"toml", c.toml},
          {"seed", std::to_string(c.seed)},  // may have more digits than a number of the page
          {"version", c.program_version},
          {"revision", c.program_revision},
          {"machine", c.machine},
          {"created", c.created},
          {"updated", c.updated},
          {"extensions", extensions},
          {"resolved", page.study ? Json(describe(*page.study)) : Json()}};
}

}  // namespace

std::string summary_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Json json = {{"state", words(contents.state)},
               {"seconds", contents.seconds},
               {"evaluations", contents.evaluations()},
               {"reproducible", contents.reproducible()},
               {"notes", contents.notes},
               {"unreadable", page.unreadable},
               {"table", table(page)},
               {"stages", stages(contents)},
               {"optimality", optimality(contents)},
               {"origin", origin(page)}};
  if (contents.final) {
    json["active"] = contents.final->active;
    json["touches_box"] = contents.final->best && contents.final->best->touches_box;
  }
  return json_text(json);
}

}  // namespace pkm
