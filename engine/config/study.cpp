#include "engine/config/study.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/config/choices.hpp"
#include "engine/config/limb_patterns.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/study_additions.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/diagnosis.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

// Maximum number of cells of a workspace that is evaluated when a study is read.
constexpr std::int64_t kMaxCellsOfCheck = 1'000'000;

std::string stem(const std::string& file_name) { return std::filesystem::path(file_name).stem().string(); }

void read_study_table(const ConfigValue& root, Study& study) {
  study.name = stem(study.file_name);
  const auto table = root.find_table("study");
  if (!table) return;
  if (const auto name = table->find("name")) study.name = name->text("text");
  if (const auto seed = table->find("seed")) study.seed = static_cast<std::uint64_t>(seed->integer());
  if (const auto output = table->find("output")) {
    study.output = output->text("a file name");
    if (study.output->empty() || study.output->find('\0') != std::string::npos) throw output->error("a file name");
  }
}

/// Reads [checkpoint] and [final], which have one key each.
void read_run_tables(const ConfigValue& root, StudyDraft& draft) {
  if (const auto table = root.find_table("checkpoint")) draft.study.checkpoint_every = table->find_number("every");
  if (const auto table = root.find_table("final")) {
    if (const auto round = table->find("round")) {
      // The step to which values are rounded has the unit that all variables share, or "1" if their units differ.
      const auto& variables = draft.parts.space.variables();
      if (variables.empty()) throw round->refusal("only [variables] are rounded, and the study has none");
      std::string& unit = draft.study.round_unit = variables.front().unit;
      for (const auto& variable : variables)
        if (variable.unit != unit) unit = "1";
      draft.study.round = round->number(unit);
      if (!(*draft.study.round > 0)) throw round->error("a step > 0");
    }
  }
}

/// Warns if the workspace is empty, for example because a fixed coordinate is out of reach or a box has a wrong unit.
/// Without the warning, users would notice it only at the end of the run.
void warn_of_empty_workspace(Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  const WorkspacePlan& plan = parts.plan;
  if (const VoxelOptions* const voxels = plan.voxels()) {
    std::int64_t cells = 1;
    for (const std::int64_t n : voxels->cells) cells *= n;  // the product is at most 2^28
    for (const FixedCoordinate& fixed : plan.fixed) cells *= std::max<std::int64_t>(1, fixed.cells);
    if (cells > kMaxCellsOfCheck) return;
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
  constexpr double kMaxSeconds = 1;  // time limit of this check [s]
  const StopScope limit(kMaxSeconds);
  try {
    if (study.problem->workspace(design).volume > 0) return;
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return;
  } catch (const DesignError&) {
    return;  // a mass is invalid; the error is reported when the design is evaluated
  }
  std::string where;
  for (const int coordinate : sweep_of(info, plan).fixed) {
    using Kind = FixedCoordinate::Kind;
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(coordinate)];
    const FixedCoordinate fixed = how_fixed(plan, coordinate);
    if (fixed.kind == Kind::value) where += " on the plane " + axis.name + " = " + with_unit(fixed.value, axis.unit);
    if (fixed.kind == Kind::default_value) where += " at the default value of " + axis.name;
    if (fixed.kind == Kind::integrated) where += " at any " + axis.name;
  }
  study.warnings.push_back("the workspace of " + what + " is empty: no pose" + where +
                           (plan.box() ? " in the box" : "") + " is feasible");
}

/// Warns if the target of a stage can never be reached, because it is outside the range of the objective.
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
void read_problem(const ConfigValue& root, StudyDraft& draft) {
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
}

using FindFile = std::function<SourceText(const ConfigValue& file)>;

/// The document of a study, and the files that it names.
struct StudySource {
  TomlValue document;
  SourceText text;
  FindFile description, catalogue;
  StudyChanges changes = {};
  ImpliedConstraints implied = ImpliedConstraints::added;
};

/// Reads a study, with the values of the given row of each catalogue.
Study read_rows(const StudySource& source, const Catalogues& catalogues, const std::vector<Catalogue>& choices,
                const std::vector<std::size_t>& rows,
                const std::shared_ptr<ExternalFunctions>& functions = std::make_shared<ExternalFunctions>()) {
  const std::string& file_name = source.text.file_name;
  const TomlValue document = with_rows(source.document, file_name, choices, rows);
  const ConfigValue root = ConfigValue(document, file_name, "").described_by(study_keys());
  StudyDraft draft{.catalogues = catalogues,
                   .description = source.description,
                   .study = {},
                   .parts = {},
                   .from_catalogues = choices,
                   .implied = source.implied};
  StudyChanges changes = source.changes;
  std::erase_if(changes.recorded_parameters, [of_rows = parameters_of_rows(source.document, choices)](
                                                 const auto& each) { return contains(of_rows, each.first); });
  draft.parts.functions = functions;
  draft.parts.rows = rows;
  draft.study.text = source.changes.empty() ? source.text.text : with_changes(source.text.text, source.changes);
  draft.study.file_name = file_name;
  read_overrides(root, draft);
  draft.changes.push_back(changes);
  for (const StudyChanges& each : draft.changes)
    std::ranges::copy(each.arguments(), std::back_inserter(draft.study.changes));
  read_study_table(root, draft.study);
  read_problem(root, draft);
  override_starts(draft);
  read_tolerances(
      root, [&root](StudyDraft& machine) { read_problem(root, machine); }, draft);
  for (const std::string& name : parameters_of_rows(source.document, choices))
    draft.parts.of_rows.push_back(
        static_cast<std::size_t>(find_named(draft.info().parameters, name) - draft.info().parameters.data()));
  if (!choices.empty()) {
    StudySource again = source;
    again.description = [description = draft.study.description](const ConfigValue&) { return description.value(); };
    draft.parts.with_rows = [again, catalogues, choices, functions](const std::vector<std::size_t>& others) {
      return read_rows(again, catalogues, choices, others, functions).problem;
    };
  }
  draft.study.problem = root.find("workspace").value_or(*root.find("mechanism")).explained([&draft] {
    return std::make_shared<const DesignProblem>(draft.parts);
  });
  read_references(root, draft);
  read_stages(root, draft);
  read_run_tables(root, draft);
  return std::move(draft.study);
}

/// Makes the problem of every row of the catalogues once, so that errors in a catalogue are reported when the study is
/// read.
void check_rows(const Study& study, const SourceLocation& place) {
  const ProblemParts& parts = study.problem->parts();
  for (const Choice& choice : parts.choices)
    for (std::size_t row = 0; row < choice.rows.size(); ++row) {
      std::vector<double> parameters = parts.parameters;
      parameters[choice.parameter] = static_cast<double>(row + 1);
      try {
        study.problem->of(parameters);
      } catch (const DesignError& error) {
        throw ConfigError({place.file, 0, "variables." + choice.variable},
                          "the row '" + choice.rows[row] + "': " + error.what());
      }
    }
}

Study read_document(StudySource source, const Catalogues& catalogues) {
  const TomlValue& document = source.document;
  const std::string& file_name = source.text.file_name;
  if (document.keys.empty())
    throw ConfigError({file_name, 0, ""}, "an empty file", "a study in TOML, with [mechanism] at least");
  if (describes_mechanism(document))
    throw ConfigError({file_name, 0, ""}, "a mechanism file",
                      "a study, which refers to this file by [mechanism] file = \"..\"");
  source.document = with_limb_patterns(document, file_name, source.description);
  const auto find_catalogue = [&](const ConfigValue& file) {
    if (const auto recorded = recorded_catalogue(document, file.text("the name of a catalogue's file")))
      return *recorded;
    return source.catalogue(file);
  };
  const std::vector<Catalogue> choices = read_catalogues(document, file_name, find_catalogue);
  Study study = read_rows(source, catalogues, choices, rows_of_baseline(document, file_name, choices));
  for (const Catalogue& choice : choices) {
    study.catalogues.push_back(choice.file.file_name);
    const std::string name = document.find("variables")->find(choice.variable)->find("from")->text;
    if (!recorded_catalogue(document, name)) study.text = with_catalogue(study.text, {choice.file.text, name});
  }
  check_rows(study, {file_name, 0, ""});
  for (std::string& warning : consistency_warnings(study.problem->parts()))
    study.warnings.push_back(std::move(warning));
  warn_of_targets(study);
  warn_of_empty_workspace(study);
  return study;
}

/// For a study that is read from a study file (HDF5): function that returns the text of the mechanism file as recorded
/// there, instead of reading a file.
FindFile known_description(const std::optional<SourceText>& description) {
  return [&description](const ConfigValue& file) {
    if (!description) throw file.refusal("the contents of the mechanism file are not available here");
    return *description;
  };
}

/// For a study that is read from a study file (HDF5): refuses to read a catalogue from disk, because the recorded text
/// contains all catalogues of the study.
SourceText unknown_catalogue(const ConfigValue& file) {
  throw file.refusal("the contents of the catalogue are not available here");
}

/// Reads a file that a study names, relative to the folder of the study.
/// @param owner  whose file it is, for messages: "a mechanism"
SourceText load_file(const ConfigValue& file, const std::string& owner, const std::string& what) {
  const std::string expected = "the name of " + owner + "'s file";
  const std::string& name = file.text(expected);
  if (name.empty() || name.find('\0') != std::string::npos) throw file.error(expected);
  const auto [study, line, key] = file.place();
  const std::string path = (std::filesystem::path(study).parent_path() / name).string();
  return {read_text_file(path, what + " in TOML that " + study + ":" + std::to_string(line) + " names"), path};
}
SourceText load_description(const ConfigValue& file) { return load_file(file, "a mechanism", "the mechanism"); }
SourceText load_catalogue(const ConfigValue& file) { return load_file(file, "a catalogue", "the catalogue"); }

}  // namespace

std::string Study::output_file() const { return output ? *output : stem(file_name) + ".h5"; }

bool describes_mechanism(const TomlValue& document) {
  const TomlValue* const table = document.find("mechanism");
  return document.find("platform") || (table && table->find("name") && !table->find("type") && !table->find("file"));
}

std::vector<OptionSpec> with_entry_unit(std::vector<OptionSpec> specs, const std::string& unit) {
  for (auto& spec : specs)
    if (spec.unit == kUnitOfEntry) spec.unit = unit;
  return specs;
}

Study read_study_toml(const std::string& text, const std::string& file_name, const Catalogues& catalogues,
                      const std::optional<SourceText>& description, const StudyChanges& changes,
                      ImpliedConstraints implied) {
  return read_document({parse_toml(text, file_name),
                        {text, file_name},
                        known_description(description),
                        unknown_catalogue,
                        changes,
                        implied},
                       catalogues);
}

Study read_study_document(const TomlValue& document, const std::string& file_name, const Catalogues& catalogues,
                          const std::optional<SourceText>& description, const StudyChanges& changes) {
  return read_document({document, {"", file_name}, known_description(description), unknown_catalogue, changes},
                       catalogues);
}

Study load_study_toml(const std::string& path, const Catalogues& catalogues, const StudyChanges& changes) {
  const SourceText source{read_text_file(path, "a study in TOML"), path};
  return read_document({parse_toml(source.text, path), source, load_description, load_catalogue, changes}, catalogues);
}

MechanismOrStudy load_mechanism_or_study(const std::string& path, const Catalogues& catalogues,
                                         const StudyChanges& changes) {
  const std::string expected = "a study or a mechanism in TOML";
  const SourceText source{read_text_file(path, expected), path};
  const TomlValue document = parse_toml(source.text, path, expected);
  if (describes_mechanism(document)) {
    const auto read = [&](const StudyAdditions& additions) {
      return read_mechanism_toml(source.text, path, limb_parameters(changes), additions);
    };
    const std::shared_ptr<const Mechanism> mechanism = read(nullptr);
    if (changes.joint_error.empty()) return mechanism;
    return read(joint_error_addition(mechanism->info(), changes.joint_error));
  }
  if (!changes.joint_error.empty())
    throw ConfigError({"", 0, "--joint-error"}, "a study",
                      "a mechanism; in a study, set joint_error in its table [accuracy]");
  return read_document({document, source, load_description, load_catalogue, changes}, catalogues);
}

}  // namespace pkm
