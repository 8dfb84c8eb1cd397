// `pkmopt check`: a study as it was understood, every default spelled out; nothing is run.

#include <algorithm>
#include <iostream>

#include <CLI/CLI.hpp>

#include "experiments/app/catalogue_json.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/print.hpp"

namespace pkm {
namespace {

struct CheckArguments {
  std::string study;
  bool json = false;
};

Json options_json(const Options& options) {
  Json object = Json::object();
  for (const auto& [name, value] : options.values()) object[name] = to_json(value);
  return object;
}

Json entries_json(const std::vector<StudyEntry>& entries) {
  Json list = Json::array();
  for (const auto& entry : entries)
    list.push_back(
        {{"name", entry.name}, {"type", entry.type}, {"role", entry.role}, {"options", options_json(entry.options)}});
  return list;
}

Json workspace_json(const MechanismInfo& info, const SurveyPlan& plan) {
  const auto coordinate = [&info](int i) { return info.coordinates[static_cast<std::size_t>(i)].name; };
  const Sweep& sweep = sweep_of(info, plan);
  Json json;
  const auto add_box = [&] {
    for (std::size_t k = 0; plan.box() && k < sweep.swept.size(); ++k)
      json["box"][coordinate(sweep.swept[k])] = (*plan.box())[k];
  };
  if (const VoxelOptions* voxels = plan.voxels()) {
    json["method"] = "voxels";
    for (std::size_t k = 0; k < sweep.swept.size(); ++k) json["cells"][coordinate(sweep.swept[k])] = voxels->cells[k];
    for (const HeldCoordinate& held : plan.held)
      if (held.cells > 0) json["cells"][coordinate(held.coordinate)] = held.cells;
    json["box"] = nullptr;  // derived from each design
    add_box();
  } else {
    const ColumnOptions& columns = *plan.columns();
    json["method"] = "columns";
    add_box();
    const bool fixed = columns.nodes[0] > 0;
    json["tolerance"] = fixed ? Json() : Json(columns.tolerance);
    json["nodes"] = nullptr;  // chosen from the tolerance
    std::size_t k = 0;
    for (const int swept : sweep.swept)
      if (fixed && swept != sweep.column) json["nodes"][coordinate(swept)] = columns.nodes[k++];
  }
  using Kind = HeldCoordinate::Kind;
  for (const int i : sweep.held) {
    const HeldCoordinate held = how_held(plan, i);
    json[coordinate(i)] = held.kind == Kind::middle       ? Json("middle")
                          : held.kind == Kind::integrated ? Json("integrated")
                          : held.kind == Kind::listed     ? Json(held.values)
                                                          : Json(held.value);
  }
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const auto& given = plan.limits.given[i];
    json["limits"][info.limits[i].name] = given                    ? Json(*given)
                                          : plan.limits.derived[i] ? Json(info.limits[i].derivation)
                                                                   : Json();
  }
  return json;
}

Json study_json(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  Json json = {{"name", study.name},          {"file", study.file_name},
               {"seed", study.seed},          {"output", study.output_file()},
               {"mechanism", info.name},      {"masses", mass_model_json(*parts.mechanism)},
               {"parameters", Json::object()}};
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    if (std::find(parts.varies.begin(), parts.varies.end(), i) == parts.varies.end())
      json["parameters"][info.parameters[i].name] = parts.parameters[i];
  json["variables"] = Json::array();
  for (const auto& v : parts.space.variables())
    json["variables"].push_back({{"name", v.name},
                                 {"unit", v.unit},
                                 {"min", v.lower},
                                 {"max", v.upper},
                                 {"step", v.step > 0 ? Json(v.step) : Json()}});
  json["baseline"] = study.baseline ? values_by_name(info.parameters, *study.baseline) : Json();
  json["workspace"] = workspace_json(info, parts.plan);
  json["regions"] = Json::object();
  for (const Region& region : parts.regions) json["regions"][region.name] = workspace_json(info, region.plan);
  json["objectives"] = entries_json(study.objectives);
  json["constraints"] = entries_json(study.constraints);
  json["reports"] = entries_json(study.reports);
  json["stages"] = Json::array();
  for (const auto& stage : study.stages)
    json["stages"].push_back({{"optimiser", stage.entry->name}, {"options", options_json(stage.options)}});
  json["warnings"] = study.warnings;
  return json;
}

int check(const Catalogues& catalogues, const CheckArguments& arguments) {
  const Study study = load_study_toml(arguments.study, catalogues);
  if (arguments.json)
    print_json(std::cout, study_json(study));
  else
    std::cout << describe(study);
  return kDone;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand("check", "The resolved problem, every default spelled out, nothing run.");
  command->add_option("STUDY.toml", arguments->study, "The study's path")->type_name("")->required();
  command->add_flag("--json", arguments->json, "Print one JSON object, numbers in full precision");
  command->footer(
      "Exit code 2 and one sentence with file, line and key when the study is wrong.\n"
      "Example: pkmopt check experiments/4ppa-2par/paper-problem.toml");
  command->callback([&session, arguments] { session.exit_code = check(session.catalogues, *arguments); });
}

}  // namespace pkm
