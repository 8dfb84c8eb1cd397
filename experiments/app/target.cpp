#include "experiments/app/target.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "engine/config/assignments.hpp"
#include "engine/config/built_in_files.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/motion_table.hpp"
#include "engine/config/study_additions.hpp"
#include "engine/config/study_changes.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/recorded_study.hpp"

namespace pkm {
namespace {

Target mechanism_target(std::shared_ptr<const Mechanism> mechanism) {
  Target target;
  target.limits = no_limits(mechanism->info());
  for (const auto& parameter : mechanism->info().parameters) target.parameters.push_back(parameter.nominal);
  target.mechanism = std::move(mechanism);
  target.words = "the nominal design";
  target.file_name = "nominal";
  return target;
}

Target study_target(Study study) {
  const ProblemParts& parts = study.problem->parts();
  Target target;
  target.mechanism = parts.mechanism;
  target.limits = parts.plan.limits;
  target.parameters = study.baseline.value_or(parts.parameters);
  target.words = study.baseline ? "the baseline" : "the study's parameters";
  target.file_name = study.baseline ? "baseline" : "parameters";
  target.study = std::move(study);
  return target;
}

/// Finds a built-in mechanism by name, or reads a mechanism or a study from a file.
/// @param files  kinds of files that are accepted, for the message
MechanismOrStudy find_by_name(const Catalogues& catalogues, const std::string& name, const std::string& files,
                              const StudyChanges& changes = {}) {
  std::vector<std::string> known;
  for (const auto& mechanism : catalogues.mechanisms) {
    known.push_back(mechanism.name());
    if (known.back() != name) continue;
    const std::vector<LimbParameter> own = limb_parameters(changes);
    if (changes.joint_error.empty() && own.empty()) return mechanism.get();
    StudyAdditions additions;
    if (!changes.joint_error.empty()) additions = joint_error_addition(mechanism.get()->info(), changes.joint_error);
    return built_in_mechanism(name, additions, own);
  }
  if (looks_like_file(name)) return load_mechanism_or_study(name, catalogues, changes);
  throw ConfigError({}, "'" + name + "', which is neither a mechanism nor a file",
                    "one of the mechanisms " + join(known) + ", or " + files, nearest_name(name, known));
}

Target named_target(const Catalogues& catalogues, const std::string& name, const StudyChanges& changes) {
  MechanismOrStudy found = find_by_name(catalogues, name, "a file in TOML of a study or a mechanism", changes);
  if (const auto* const mechanism = std::get_if<std::shared_ptr<const Mechanism>>(&found)) {
    Target target = mechanism_target(*mechanism);
    target.files = {name};
    return target;
  }
  Target target = study_target(std::get<Study>(std::move(found)));
  target.files = {name};
  if (target.study->description) target.files.push_back(target.study->description->file_name);
  target.files.insert(target.files.end(), target.study->catalogues.begin(), target.study->catalogues.end());
  return target;
}

Target study_file_target(const Session& session, const DesignArguments& arguments) {
  const StudyContents contents = read_study(arguments.from);
  Target target = study_target(recorded_study(contents, arguments.from, session, arguments.changes));
  static_cast<ChosenDesign&>(target) = chosen_design(contents, *target.study, arguments.choice);
  target.files = {arguments.from};
  return target;
}

Target select_target(const Session& session, const DesignArguments& arguments) {
  if (arguments.from.empty() == arguments.target.empty())
    throw ConfigError({}, arguments.from.empty() ? "no design" : "'" + arguments.target + "' together with --from",
                      "a mechanism, a file in TOML or --from F.h5");
  if (!arguments.from.empty()) return study_file_target(session, arguments);
  if (const char* const option = first_given_option(arguments.choice))
    throw ConfigError({"", 0, option}, "no --from", "--from F.h5 together with it");
  return named_target(session.catalogues, arguments.target, arguments.changes);
}

void set_masses(Target& target, const std::string& model) {
  const MechanismInfo& info = target.info();
  if (target.study)
    throw ConfigError({"", 0, "--masses"}, "'" + model + "' together with a study",
                      "a mechanism; in a study, set masses = \"..\" in its table [mechanism]");
  const Dynamics* const dynamics = target.mechanism->dynamics();
  if (!dynamics) throw ConfigError({"", 0, "--masses"}, "the mechanism " + info.name + " has no masses");
  const auto other = dynamics->with_masses(model);
  if (!other)
    throw ConfigError({"", 0, "--masses"}, "'" + model + "'", "one of " + join(dynamics->mass_models()),
                      nearest_name(model, dynamics->mass_models()));
  const auto files = std::move(target.files);
  target = mechanism_target(other);
  target.files = files;
}

}  // namespace

WorkspacePlan Target::plan() const {
  WorkspacePlan plan;
  if (study) plan = study->problem->parts().plan;
  plan.limits = limits;
  return plan;
}

void add_choice_options(CLI::App& command, DesignChoice& choice) {
  command.add_flag("--baseline", choice.baseline, "Use the study's baseline instead of its best design");
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  add_integer(command, "--generation G", choice.generation, 0, kMax,
              "Use a design of generation G of a stage (the first is 0), selected by --individual");
  add_integer(command, "--individual I", choice.individual, 0, kMax, "Number of the design in the population, from 1");
  add_integer(command, "--front N", choice.front, 0, kMax, "Use point N of the Pareto front (see 'pkmopt show F.h5')");
  add_integer(command, "--stage N", choice.stage, 0, kMax,
              "Stage of --generation or --front (default: the last stage that has one)");
}

const char* first_given_option(const DesignChoice& choice) {
  return choice.baseline     ? "--baseline"
         : choice.generation ? "--generation"
         : choice.individual ? "--individual"
         : choice.front      ? "--front"
         : choice.stage      ? "--stage"
                             : nullptr;
}

CLI::Option* add_list_option(CLI::App& command, const std::string& option, std::vector<std::string>& lists,
                             const std::string& meaning) {
  return add_option(command, option + " NAME=VALUE", lists, meaning + "; separated by commas or repeated")
      ->allow_extra_args(false);
}

void add_cells_option(CLI::App& command, std::vector<std::string>& lists, const std::string& meaning) {
  add_option(command, "--cells N|NAME=N", lists, meaning + "; one number for all axes, or by name, separated by commas")
      ->allow_extra_args(false);
}

void add_limit_option(CLI::App& command, std::vector<std::string>& lists) {
  add_list_option(command, "--limit", lists, "Thresholds of pose limits, overriding those of the study");
}

void add_change_options(CLI::App& command, StudyChanges& changes) {
  add_list_option(command, "--set", changes.set, "Values of fixed parameters, overriding those of the study");
  add_limit_option(command, changes.limit);
  add_cells_option(command, changes.cells, "Cells of the study's voxel grid");
}

void add_mode_options(CLI::App& command, ModeArguments& arguments) {
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'); default: the first");
  add_option(command, "--branch SIGN", arguments.branch,
             "Required assembly branch, for mechanisms that have several; default: the first");
}

double parse_gap(const std::string& text, const std::string& option) {
  const double gap = parse_number(text, option, "1");
  if (!(gap > 0 && gap < 2)) throw ConfigError({"", 0, option}, text, "a number between 0 and 2");
  return gap;
}

std::shared_ptr<const Motion> find_motion(const Target& target, const std::string& name) {
  if (target.study) {
    const auto& motions = target.study->motions;
    if (const DesignMotion* known = find_named(motions, name)) return known->at(target.parameters);
    if (!motions.empty() && !looks_like_file(name))
      throw ConfigError({"", 0, "--motion"}, "'" + name + "', which is neither a [[motion]] of the study nor a file",
                        "one of " + join(names_of(motions)) + ", or a motion in TOML",
                        nearest_name(name, names_of(motions)));
  }
  return load_motion(name, motion_names(*target.mechanism, target.parameters));
}

std::string parse_mode(const MechanismInfo& info, const ModeArguments& arguments) {
  const auto& [mode, branch] = arguments;
  const SourceLocation place{"", 0, "--branch"};
  if (!branch.empty() && info.branches.empty())
    throw ConfigError(place, "mechanism " + info.name + " has one branch only");
  if (!branch.empty() && std::ranges::find(info.branches, branch) == info.branches.end())
    throw ConfigError(place, "'" + branch + "'", "one of " + join(info.branches));
  if (!branch.empty() && mode.find('/') != std::string::npos)
    throw ConfigError(place, "the mode " + mode + " already specifies its branch");
  if (!branch.empty() && branch != info.branches.front())
    return parse_mode(info, {(mode.empty() ? info.modes.front() : mode) + "/" + branch, ""});
  if (mode.empty()) return info.modes.front();
  if (std::ranges::find(info.modes, mode) != info.modes.end()) return mode;
  throw ConfigError({"", 0, "--mode"}, "the unknown mode '" + mode + "'", "one of " + join(info.modes, "; "),
                    nearest_name(mode, info.modes));
}

MotionSample parse_motion(const Mechanism& mechanism, const MotionArguments& arguments) {
  const auto pose = parse_all_assignments(arguments.at, "--at", assignable_axes(mechanism.info().coordinates));
  const auto rates = parse_some_assignments(arguments.velocity, "--velocity", assignable_rates(mechanism, "s"));
  const auto changes =
      parse_some_assignments(arguments.acceleration, "--acceleration", assignable_rates(mechanism, "s^2"));
  const std::size_t n = pose.size();
  MotionSample sample{.pose = axis_vector(pose),
                      .velocity = axis_vector(std::span(rates).first(n)),
                      .acceleration = axis_vector(std::span(changes).first(n))};
  const auto& inputs = mechanism.info().inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    sample.inputs.push_back({inputs[i].value, rates[n + i], changes[n + i]});
  return sample;
}

void add_design_arguments(CLI::App& command, DesignArguments& arguments) {
  add_option(command, "MECHANISM|FILE.toml", arguments.target,
             "Name of a mechanism, or path of a mechanism file or a study; or use --from");
  add_option(command, "--from F.h5", arguments.from,
             "Use the best design of a study file (of a Pareto front the compromise), and its problem");
  add_design_options(command, arguments);
}

void add_design_options(CLI::App& command, DesignArguments& arguments) {
  add_choice_options(command, arguments.choice);
  add_list_option(command, "--set", arguments.set,
                  "Parameter values, overriding those of the baseline, else the default values");
  add_limit_option(command, arguments.changes.limit);
  add_option(command, "--masses MODEL", arguments.masses,
             "Mass model of a mechanism (see 'pkmopt list'); a study specifies its own");
  command.add_flag("--json", arguments.json, "Print one JSON object, numbers in full precision");
}

void add_table_output(CLI::App& command, TableOutput& output, const std::string& meaning) {
  add_option(command, "-o,--csv FILE", output.csv, meaning);
  command.add_flag("--force", output.force, "Overwrite the file if it exists");
}

void write_table(const TableOutput& output, const CsvTable& table) {
  write_file(output.csv, table.text(), if_forced(output.force));
}

std::shared_ptr<const Mechanism> find_mechanism(const Catalogues& catalogues, const std::string& name) {
  const MechanismOrStudy found = find_by_name(catalogues, name, "a mechanism file");
  if (const auto* const mechanism = std::get_if<std::shared_ptr<const Mechanism>>(&found)) return *mechanism;
  throw ConfigError({name, 0, ""}, "a study", "a mechanism file");
}

bool looks_like_file(const std::string& name) {
  std::error_code ignored;  // errors are reported by the attempt to read the file
  return name.ends_with(".toml") || std::filesystem::exists(name, ignored);
}

Target find_target(const Session& session, const DesignArguments& given_arguments) {
  DesignArguments arguments = given_arguments;
  for (const std::string& name : assigned_names(arguments.set))
    if (name.find('.') != std::string::npos) arguments.changes.limb_parameters.push_back(name);
  Target target = select_target(session, arguments);
  if (!arguments.masses.empty()) set_masses(target, arguments.masses);
  if (!target.study) {
    const auto limits = parse_assignments(arguments.changes.limit, "--limit", assignable_limits(target.info()));
    for (std::size_t i = 0; i < limits.size(); ++i) target.limits.given[i] = limits[i];
  }
  if (!arguments.changes.empty()) target.words += " with " + join(arguments.changes.arguments(), " ");
  const auto given = parse_assignments(arguments.set, "--set", assignable_parameters(target.info()));
  for (std::size_t i = 0; i < given.size(); ++i)
    if (given[i]) target.parameters[i] = *given[i];
  if (target.study)
    for (const auto& [own, common] : target.study->problem->parts().copies)
      if (given[common] && !given[own]) target.parameters[own] = target.parameters[common];
  if (!arguments.set.empty()) {
    target.words += " with " + join(arguments.set);
    target.file_name += "-changed";
  }
  if (target.study) {
    const DesignProblem& problem = target.study->problem->of(target.parameters);
    const std::vector<std::size_t>& chosen = target.study->problem->parts().of_rows;
    for (const std::size_t i : chosen)
      if (!given[i]) target.parameters[i] = problem.parts().parameters[i];
    target.mechanism = problem.parts().mechanism;
  }
  if (const Unsupported reason = target.mechanism->refuse(target.parameters))
    throw ConfigError({"", 0, "--set"}, *reason);
  return target;
}

}  // namespace pkm
