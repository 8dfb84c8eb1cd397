// `pkmopt check`: prints a study as it was interpreted, with all defaults, contradictions between its requirements and
// the feasibility of a few sample designs; or a mechanism file as it was interpreted. Nothing is optimised.

#include <algorithm>
#include <iostream>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/team.hpp"
#include "engine/problem/diagnosis.hpp"
#include "engine/report/json_text.hpp"
#include "engine/runner/final_record.hpp"
#include "engine/runner/probe.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/catalogue.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/run.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct CheckArguments {
  std::string file;
  StudyChanges changes;
  bool json = false;
};

Json options_json(const Options& options) {
  Json object = Json::object();
  for (const auto& [name, value] : options.values()) object[name] = to_json(value);
  return object;
}

Json entries_json(const std::vector<StudyEntry>& entries) {
  return list_json(entries, [](const StudyEntry& entry) -> Json {
    return {{"name", entry.name}, {"type", entry.type}, {"role", entry.role}, {"options", options_json(entry.options)}};
  });
}

Json workspace_json(const MechanismInfo& info, const WorkspacePlan& plan) {
  const Sweep& sweep = sweep_of(info, plan);
  const std::vector<std::string> swept = coordinate_names(info, sweep.swept);
  Json json = {{"method", plan.voxels() ? "voxels" : "columns"}, {"sweep", swept}};
  if (const VoxelOptions* voxels = plan.voxels()) {
    for (std::size_t k = 0; k < swept.size(); ++k) json["cells"][swept[k]] = voxels->cells[k];
    for (const FixedCoordinate& fixed : plan.fixed)
      if (fixed.cells > 0) json["cells"][coordinate_names(info, {fixed.coordinate})[0]] = fixed.cells;
    json["box"] = nullptr;  // null: the box is computed for each design
  }
  for (std::size_t k = 0; plan.box() && k < swept.size(); ++k) json["box"][swept[k]] = (*plan.box())[k];
  json["home"] = nullptr;  // null: all components of the workspace are measured
  for (std::size_t k = 0; plan.home && k < swept.size(); ++k) json["home"][swept[k]] = (*plan.home)[k];
  if (const ColumnOptions* columns = plan.columns()) {
    const bool fixed = columns->nodes[0] > 0;
    json["tolerance"] = fixed ? Json() : Json(columns->tolerance);
    json["certified"] = json_or_null(columns->certified);
    json["nodes"] = nullptr;  // null: the numbers of nodes follow from the tolerance
    std::size_t node = 0;
    for (std::size_t k = 0; k < swept.size(); ++k)
      if (fixed && sweep.swept[k] != sweep.column) json["nodes"][swept[k]] = columns->nodes[node++];
  }
  for (const int i : sweep.fixed) {
    using Kind = FixedCoordinate::Kind;
    const FixedCoordinate fixed = how_fixed(plan, i);
    json[coordinate_names(info, {i})[0]] = fixed.kind == Kind::default_value ? Json("middle")
                                           : fixed.kind == Kind::integrated  ? Json("integrated")
                                           : fixed.kind == Kind::listed      ? Json(fixed.values)
                                                                             : Json(fixed.value);
  }
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const auto& given = plan.limits.given[i];
    json["limits"][info.limits[i].name] =
        plan.limits.derived[i] && !given ? Json(info.limits[i].derivation) : json_or_null(given);
  }
  return json;
}

Json obstacles_json(const Obstacles& obstacles) {
  Json json = Json::array();
  for (const Obstacle& obstacle : obstacles) {
    if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape)) {
      const auto& h = box->half;
      json.push_back({{"name", obstacle.name},
                      {"shape", "box"},
                      {"centre", box->centre},
                      {"size", {2 * h[0], 2 * h[1], 2 * h[2]}}});
      continue;
    }
    const auto& [axis, radius] = std::get<Capsule<double>>(obstacle.shape);
    if (axis.from == axis.to)
      json.push_back({{"name", obstacle.name}, {"shape", "sphere"}, {"centre", axis.from}, {"radius", radius}});
    else
      json.push_back(
          {{"name", obstacle.name}, {"shape", "capsule"}, {"from", axis.from}, {"to", axis.to}, {"radius", radius}});
  }
  return json;
}

Json tolerances_json(const ToleranceModel& model) {
  Json json = {{"samples", model.samples}, {"errors", Json::object()}};
  for (const ParameterError& error : model.errors)
    json["errors"][error.name] = {{"bound", error.bound}, {"sigma", error.sigma > 0 ? Json(error.sigma) : Json()}};
  return json;
}

Json study_json(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  Json json = {{"name", study.name},
               {"file", study.file_name},
               {"seed", study.seed},
               {"output", study.output_file()},
               {"mechanism", info.name},
               {"mechanism_file", study.description ? Json(study.description->file_name) : Json()},
               {"masses", mass_model_json(*parts.mechanism)},
               {"parameters", Json::object()}};
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    if (std::ranges::find(parts.varies, i) == parts.varies.end())
      json["parameters"][info.parameters[i].name] = parts.parameters[i];
  json["variables"] = list_json(parts.space.variables(), [](const Variable& v) -> Json {
    const Json step = v.step > 0 ? Json(v.step) : Json();
    return {{"name", v.name}, {"unit", v.unit}, {"min", v.lower}, {"max", v.upper}, {"step", step}};
  });
  for (const Choice& choice : parts.choices)
    for (Json& variable : json["variables"])
      if (variable["name"] == choice.variable) variable["choices"] = choice.rows;
  json["baseline"] = study.baseline ? values_by_name(info.parameters, *study.baseline) : Json();
  json["workspace"] = workspace_json(info, parts.plan);
  if (parts.plan.voxels()) json["workspace"]["exact"] = has_exact_step(study) ? Json(study.exact_seconds) : Json(false);
  json["regions"] = Json::object();
  for (const Region& region : parts.regions) json["regions"][region.name] = workspace_json(info, region.plan);
  json["obstacles"] = obstacles_json(parts.plan.limits.obstacles);
  json["tolerance"] = study.tolerances ? tolerances_json(*study.tolerances) : Json();
  json["objectives"] = entries_json(study.objectives);
  json["constraints"] = entries_json(study.constraints);
  json["outputs"] = entries_json(study.outputs);
  json["stages"] = list_json(study.stages, [](const Stage& stage) -> Json {
    return {{"optimiser", stage.entry->name}, {"options", options_json(stage.options)}};
  });
  json["warnings"] = study.warnings;
  return json;
}

Json probe_json(const Probe& probe) {
  return {
      {"designs", probe.table.size()}, {"feasible", probe.feasible()}, {"diagnosis", diagnosis_json(probe.diagnosis)}};
}

/// Text of the results of the sample designs, without the contradictions between requirements, which were printed
/// before.
std::string probe_text(const Probe& probe) {
  std::string text = "\nprobe: " + describe_probe(probe) + '\n';
  if (!probe.diagnosis) return text;
  std::vector<Reason> reasons = probe.diagnosis->reasons;
  const bool contradicts =
      std::erase_if(reasons, [](const Reason& reason) { return reason.kind == "contradiction"; }) > 0;
  return text + "note: " + probe.diagnosis->sentence +
         (contradicts ? "\n" : "; a run may still find feasible designs\n") + reasons_text(reasons);
}

void check_study(const Study& study, const CheckArguments& arguments, Session& session) {
  start_python(study, arguments.file, 1, 0);
  const std::vector<Reason> conflicts = contradictions(study.problem->parts());
  const Probe sampled = probe(study);
  if (!conflicts.empty()) session.exit_code = kNothingFeasible;
  if (arguments.json) {
    Json json = study_json(study);
    json["contradictions"] = reasons_json(conflicts);
    json["probe"] = probe_json(sampled);
    print_json(json);
    return;
  }
  std::cout << describe(study);
  for (const Reason& reason : conflicts) std::cout << "\ncontradiction: " << reason.sentence << '\n';
  std::cout << probe_text(sampled);
  std::vector<std::string> words = {"run", arguments.file};
  for (const std::string& word : arguments.changes.arguments()) words.push_back(word);
  if (!conflicts.empty()) return;
  std::cout << '\n';
  if (!study.stages.empty()) {
    print_estimate(study, measured_cost(study, session), 1, team_size(0));
    std::cout << '\n';
  }
  std::cout << next_step(session, words);
}

void check(const CheckArguments& arguments, Session& session) {
  expect_toml(arguments.file, "show", session);
  expect_file(arguments.file, "a study or a mechanism in TOML", "list mechanisms", session);
  const SlowStepNotice slow = announce_slow_step(session, "check is computing, Ctrl-C ends it");
  const MechanismOrStudy found = load_mechanism_or_study(arguments.file, session.catalogues, arguments.changes);
  if (const Study* const study = std::get_if<Study>(&found)) return check_study(*study, arguments, session);
  if (!arguments.changes.empty())
    throw ConfigError({"", 0, join(arguments.changes.arguments(), " ")},
                      "this option changes studies only, and the file describes a mechanism");
  const Mechanism& mechanism = *std::get<std::shared_ptr<const Mechanism>>(found);
  if (arguments.json)
    print_json(mechanism_json(mechanism, session.catalogues));
  else
    std::cout << describe_mechanism(mechanism) << '\n'
              << next_step(session, {"new", "study", file_argument(arguments.file), "-o", "study.toml"});
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<CheckArguments>(
      app, "check", "Show a study with all defaults, and evaluate a few sample designs.",
      "For a mechanism file: how it was interpreted, and which analyses it supports.\n"
      "Exit code 2 and one sentence with file, line and key if the file is invalid; 4 if the\n"
      "requirements of a study contradict each other, so that no design can be feasible.\n"
      "Example: pkmopt check experiments/4ppa-2par/paper-problem.toml",
      [&session](const CheckArguments& given) { check(given, session); });
  add_option(command, "FILE.toml", arguments.file, "A study or a mechanism file")->required();
  add_change_options(command, arguments.changes);
  command.add_flag("--json", arguments.json, "Print one JSON object, numbers in full precision");
}

}  // namespace pkm
