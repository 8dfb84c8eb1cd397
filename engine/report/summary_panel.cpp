// Computes the data of the panel "Summary": state, table of designs, active constraints, computing time, reproduction
// of the study.
#include <array>

#include "engine/report/panels.hpp"
#include "engine/results/design_table.hpp"

namespace pkm {
namespace {

/// The table of designs: one column per design of the study, then one per published reference design; null if nothing
/// has been evaluated.
Json table(const PageStudy& page) {
  const std::vector<Reference> references = page.study ? page.study->references : std::vector<Reference>();
  const DesignTable designs = design_table(page.contents, references);
  if (designs.columns.empty()) return Json();
  Json columns = Json::array(), rows = Json::array();
  for (const auto& [name, record, exact] : designs.columns)
    columns.push_back(
        {{"name", name}, {"status", words(record->status)}, {"reason", record->reason}, {"reference", false}});
  for (const Reference& r : references)
    columns.push_back({{"name", r.name}, {"seconds", r.seconds ? Json(*r.seconds) : Json()}, {"reference", true}});
  for (const DesignTable::Line& line : designs.lines) {
    Json numbers = Json::array();
    for (const auto* const group : {&line.values, &line.published})
      for (const auto& value : *group) numbers.push_back(value ? Json(*value) : Json());
    rows.push_back({{"kind", line.kind},
                    {"name", line.name},
                    {"unit", line.unit},
                    {"meaning", line.meaning},
                    {"values", numbers}});
    if (line.gain) rows.back()["gain"] = {{"percent", line.gain->percent}, {"worse", line.gain->worse}};
  }
  return {{"columns", columns}, {"rows", rows}};
}

/// For each stage: wall time, total time of the evaluations over all threads, and number of evaluations with each
/// status.
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

/// KKT residual, multipliers and sensitivities of the best design, as computed by the stage that found it. If that
/// stage did not compute them, those of the last stage; null if it did not compute them either.
Json optimality(const StudyContents& contents) {
  if (contents.best.row < 0) return Json();
  const StageRecord& best_stage = contents.best_stage();
  const auto& record = best_stage.optimality ? best_stage.optimality : contents.stages.back().optimality;
  if (!record) return Json();
  Json json = {{"optimality", record->optimality}, {"active", Json::array()}, {"sensitivities", Json::array()}};
  for (const ActiveRecord& a : record->active)
    json["active"].push_back({{"name", a.name}, {"kind", a.kind}, {"multiplier", a.multiplier}, {"unit", a.unit}});
  for (const SensitivityRecord& s : record->sensitivities)
    json["sensitivities"].push_back(
        {{"name", s.parameter}, {"unit", s.unit}, {"as_built", s.as_built}, {"reoptimised", s.reoptimised}});
  return json;
}

/// The data that a user needs to run the study again.
Json origin(const PageStudy& page) {
  const StudyContents& c = page.contents;
  Json extensions = Json::array();
  for (const Extension& e : c.extensions)
    extensions.push_back({{"stage", e.stage + 1}, {"limit", e.limit}, {"value", e.value}});
  return {{"toml_file", c.toml_file},
          {"toml", c.toml},
          {"mechanism_file", c.description ? Json(c.description->file_name) : Json()},
          {"mechanism_toml", c.description ? Json(c.description->text) : Json()},
          {"seed", std::to_string(c.seed)},  // as text: 64 bits exceed the precision of a JavaScript number
          {"version", c.program_version},
          {"revision", c.program_revision},
          {"machine", c.machine},
          {"created", c.created},
          {"updated", c.updated},
          {"extensions", extensions},
          {"resolved", page.study ? Json(describe(*page.study)) : Json()}};
}

}  // namespace

Json summary_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  const DesignProblem* const problem = page.study ? page.study->problem.get() : nullptr;
  std::vector<std::string> notes = contents.notes;
  if (page.study)
    for (const std::string& difference : page.study->differences)
      notes.push_back(difference + "; the recorded value is used");
  Json json = {{"state", words(contents.state)},
               {"seconds", contents.seconds},
               {"evaluations", contents.evaluations()},
               {"reproducible", contents.reproducible()},
               {"notes", notes},
               {"diagnosis", diagnosis_json(diagnose(contents, problem))},
               {"failures", failures_text(collect_failures(contents, problem))},
               {"unreadable", page.unreadable},
               {"table", table(page)},
               {"stages", stages(contents)},
               {"optimality", optimality(contents)},
               {"origin", origin(page)}};
  if (contents.final) {
    json["active"] = contents.final->active;
    json["touches_box"] = contents.final->best && contents.final->best->touches_box;
  }
  return json;
}

}  // namespace pkm
