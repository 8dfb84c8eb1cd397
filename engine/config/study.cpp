#include "engine/config/study.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/sections.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/diagnosis.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kMostCellsOfACheck = 1'000'000;  // that are surveyed when a study is read

std::string stem(const std::string& file_name) { return std::filesystem::path(file_name).stem().string(); }

void read_study_section(const ConfigValue& root, Study& study) {
  study.name = stem(study.file_name);
  const auto table = root.find("study");
  if (!table) return;
  table->expect_table("a table [study]").allow({"name", "seed", "output"});
  if (const auto name = table->find("name")) study.name = name->text("text");
  if (const auto seed = table->find("seed")) study.seed = static_cast<std::uint64_t>(seed->integer(0));
  if (const auto output = table->find("output")) {
    study.output = output->text("a file name");
    if (study.output->empty() || study.output->find('\0') != std::string::npos) throw output->error("a file name");
  }
}

/// [checkpoint] and [final]: one key each.
void read_run_sections(const ConfigValue& root, StudyDraft& draft) {
  if (const auto table = root.find("checkpoint")) {
    table->expect_table("a table [checkpoint]").allow({"every"});
    draft.study.checkpoint_every = table->find_number("every", "s", 0);
  }
  if (const auto table = root.find("final")) {
    table->expect_table("a table [final]").allow({"round"});
    if (const auto round = table->find("round")) {
      // A step with a unit makes sense where the variables share that unit. (A stage has made sure that there are
      // some.)
      const auto& variables = draft.parts.space.variables();
      std::string& unit = draft.study.round_unit = variables.front().unit;
      for (const auto& variable : variables)
        if (variable.unit != unit) unit = "1";
      draft.study.round = round->number(unit);
      if (!(*draft.study.round > 0)) throw round->error("a step > 0");
    }
  }
}

/// A plane off the rail or a wrong unit in a box leaves no pose; a run would only tell at its end.
void warn_of_empty_workspace(Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  const WorkspacePlan& plan = parts.plan;
  if (const VoxelOptions* const voxels = plan.voxels()) {
    std::int64_t cells = 1;
    for (const std::int64_t n : voxels->cells) cells *= n;  // at most 2^28
    for (const FixedCoordinate& fixed : plan.fixed) cells *= std::max<std::int64_t>(1, fixed.cells);
    if (cells > kMostCellsOfACheck) return;
  }
  std::vector<double> design = parts.parameters;
  std::string what = "the design";
  if (study.baseline) {
    design = *study.baseline;
    what = "the baseline";
  } else if (parts.space.dimension() > 0) {
    what = "the middle of the variables' bounds";
    for (std::size_t v = 0; v < parts.space.dimension(); ++v)
      design[parts.varies[v]] = parts.space.nearest(v, (parts.space[v].lower + parts.space[v].upper) / 2);
  }
  if (parts.mechanism->refuse(design)) return;
  constexpr double kLongest = 1;  // s
  const StopScope limit(kLongest);
  try {
    if (study.problem->workspace(design).volume > 0) return;
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return;
  } catch (const DesignError&) {
    return;  // a mass that is not positive has a message of its own when the design is evaluated
  }
  std::string where;
  for (const int coordinate : sweep_of(info, plan).fixed) {
    using Kind = FixedCoordinate::Kind;
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    const FixedCoordinate fixed = how_fixed(plan, coordinate);
    if (fixed.kind == Kind::value) where += " on the plane " + axis.name + " = " + with_unit(fixed.value, axis.unit);
    if (fixed.kind == Kind::default_value) where += " on its middle plane";
    if (fixed.kind == Kind::integrated) where += " at any " + axis.name;
  }
  study.warnings.push_back("the workspace of " + what + " is empty: no pose" + where +
                           (plan.box() ? " in the box" : "") + " is feasible");
}

/// A target beyond what the objective's values can be ends no stage.
void warn_of_targets(Study& study) {
  const auto& objectives = study.problem->parts().objectives;
  for (std::size_t s = 0; objectives.size() == 1 && s < study.stages.size(); ++s) {
    const Options& options = study.stages[s].options;
    if (!options.has("target")) continue;
    const NamedQuantity& q = objectives[0];
    const double target = options.number("target");
    const bool up = q.direction == Direction::maximise;
    if (up ? target > q.range.upper : target < q.range.lower)
      study.warnings.push_back(
          "stage " + std::to_string(s + 1) + ": the target " + with_unit(target, q.unit) +
          " is never reached, because values of " + q.name + " are never " +
          (up ? "above " + with_unit(q.range.upper, q.unit) : "below " + with_unit(q.range.lower, q.unit)));
  }
}

/// Studies name a mechanism, descriptions give it a name; only these have a platform.
bool describes_mechanism(const TomlValue& document) {
  const TomlValue* const table = document.find("mechanism");
  return document.find("platform") || (table && table->find("name") && !table->find("type") && !table->find("file"));
}

using FindDescription = std::function<SourceText(const ConfigValue& file)>;

Study read_document(const TomlValue& document, const SourceText& source, const Catalogues& catalogues,
                    const FindDescription& find_description, const StudyChanges& changes,
                    ImpliedConstraints implied = ImpliedConstraints::added) {
  const std::string& file_name = source.file_name;
  if (document.keys.empty())
    throw ConfigError({file_name, 0, ""}, "an empty file", "a study in TOML, with [mechanism] and [[stage]] at least");
  if (describes_mechanism(document))
    throw ConfigError({file_name, 0, ""}, "the description of a mechanism",
                      "a study, which names such a file in [mechanism] file = \"..\"");
  const ConfigValue root(document, file_name, "");
  root.allow({"study", "mechanism", "variables", "baseline", "workspace", "region", "motion", "objective", "constraint",
              "report", "reference", "drive_train", "obstacle", "stage", "checkpoint", "final", "override"},
             "section");

  StudyDraft draft{
      .catalogues = catalogues, .description = find_description, .study = {}, .parts = {}, .implied = implied};
  draft.study.text = changes.empty() ? source.text : with_changes(source.text, changes);
  draft.study.file_name = file_name;
  read_overrides(root, draft);
  draft.changes.push_back(changes);
  for (const StudyChanges& each : draft.changes)
    std::ranges::copy(each.arguments(), std::back_inserter(draft.study.changes));
  read_study_section(root, draft.study);
  read_mechanism(root, draft);
  read_drive_trains(root, draft);
  read_variables(root, draft);
  read_baseline(root, draft);
  read_workspace(root, draft);
  read_pose_constraints(root, draft);
  read_obstacles(root, draft);
  read_regions(root, draft);
  read_motions(root, draft);
  read_quantities(root, draft);
  draft.study.problem = root.find("workspace").value_or(*root.find("mechanism")).explained([&draft] {
    return std::make_shared<const DesignProblem>(draft.parts);
  });
  read_references(root, draft);
  read_stages(root, draft);
  read_run_sections(root, draft);
  for (std::string& doubt : consistency_warnings(draft.study.problem->parts()))
    draft.study.warnings.push_back(std::move(doubt));
  warn_of_targets(draft.study);
  warn_of_empty_workspace(draft.study);
  return std::move(draft.study);
}

/// The file of a mechanism, whose name is relative to the folder of the study that names it.
SourceText load_description(const ConfigValue& file) {
  const std::string expected = "the name of a mechanism's file";
  const std::string& name = file.text(expected);
  if (name.empty() || name.find('\0') != std::string::npos) throw file.error(expected);
  const auto [study, line, key] = file.place();
  const std::string path = (std::filesystem::path(study).parent_path() / name).string();
  return {read_text_file(path, "the mechanism in TOML that " + study + ":" + std::to_string(line) + " names"), path};
}

}  // namespace

std::string Study::output_file() const { return output ? *output : stem(file_name) + ".h5"; }

void allow_options(const ConfigValue& table, std::vector<std::string> keys, const std::vector<OptionSpec>& specs) {
  for (const auto& name : names_of(specs)) keys.push_back(name);
  table.allow(keys);
}

std::vector<OptionSpec> with_entry_unit(std::vector<OptionSpec> specs, const std::string& unit) {
  for (auto& spec : specs)
    if (spec.unit == kUnitOfEntry) spec.unit = unit;
  return specs;
}

Study read_study_toml(const std::string& text, const std::string& file_name, const Catalogues& catalogues,
                      const std::optional<SourceText>& description, const StudyChanges& changes,
                      ImpliedConstraints implied) {
  const auto known = [&](const ConfigValue& file) {
    if (!description) throw file.refusal("what the mechanism's file holds is not known here");
    return *description;
  };
  return read_document(parse_toml(text, file_name), {text, file_name}, catalogues, known, changes, implied);
}

Study load_study_toml(const std::string& path, const Catalogues& catalogues, const StudyChanges& changes) {
  const SourceText source{read_text_file(path, "a study in TOML"), path};
  return read_document(parse_toml(source.text, path), source, catalogues, load_description, changes);
}

MechanismOrStudy load_mechanism_or_study(const std::string& path, const Catalogues& catalogues,
                                         const StudyChanges& changes) {
  const std::string expected = "a study or a mechanism in TOML";
  const SourceText source{read_text_file(path, expected), path};
  const TomlValue document = parse_toml(source.text, path, expected);
  if (describes_mechanism(document)) return read_mechanism_toml(source.text, path, limb_parameters(changes));
  return read_document(document, source, catalogues, load_description, changes);
}

}  // namespace pkm
