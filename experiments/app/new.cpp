// `pkmopt new`: creates a commented starter file, either a mechanism file or a study of a mechanism.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "engine/config/text_file.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxVariables = 4;
constexpr double kLowerFactor = 0.8, kUpperFactor = 1.25;  // bounds of a variable, relative to its default value
constexpr std::size_t kMaxNameLength = 60;

struct NewArguments {
  std::string kind, name, output;
  bool force = false;
};

constexpr const char* kDelta =
    R"toml(# A mechanism file for pkmopt. 'pkmopt check FILE' shows its interpretation and the analyses it supports.
[mechanism]
name   = "NAME"
title  = "three cranks, three pairs of rods, three translations"
source = "Clavel 1988"

[parameters]             # design parameters, which a study may vary; the unit is that of the default
R     = { default = "200 mm", min = "10 mm", max = "2 m", meaning = "radius of the cranks' pivots" }
r     = { default = "50 mm", min = "1 mm", max = "1 m", meaning = "radius of the platform's joints" }
l_a   = { default = "200 mm", min = "10 mm", max = "2 m", meaning = "length of a crank" }
l_b   = { default = "500 mm", min = "10 mm", max = "4 m", meaning = "length of a rod" }
q_min = { default = "-40 deg", min = "-180 deg", max = "180 deg", meaning = "minimum crank angle" }
q_max = { default = "95 deg", min = "-180 deg", max = "180 deg", meaning = "maximum crank angle" }

[platform]               # its degrees of freedom: translations "along x", rotations "about x", ..
coordinates = { x = "along x", y = "along y", z = "along z" }
characteristic_length = "r"                # makes rotations comparable with translations

[survey]                 # default search box of the workspace, as formulas of the parameters
box = { x = ["-(R+l_a+l_b)", "R+l_a+l_b"], y = ["-(R+l_a+l_b)", "R+l_a+l_b"], z = ["-(l_a+l_b)", 0] }

[[limb]]                 # for a given pose of the platform, each limb is solved on its own
name     = "arm"
copies   = { number = 3, about = "z" }     # arm1, arm2, arm3
drive    = "crank"                         # or "telescope", "slider", "formula"
base     = ["R", 0, 0]                     # the crank's pivot, in the frame of the base
axis     = [0, 1, 0]                       # direction of the pivot's axis
zero     = [1, 0, 0]                       # direction of the crank at angle 0
crank    = "l_a"
rod      = "l_b"
platform = ["r", 0, 0]                     # the rod's end, in the frame of the platform
branch   = "-"                             # elbow outwards; "+": inwards
range    = ["q_min", "q_max"]
pair     = { spacing = "60 mm" }           # two parallel rods, which keep the platform from rotating
radius   = "6 mm"                          # of the links, for clearances and drawings

[[design]]               # constraint on the parameters, checked before any pose is evaluated
name    = "rods longer than cranks"
formula = "l_b - l_a"                      # satisfied if >= 0
unit    = "m"
)toml";

/// Throws ConfigError unless the name of a mechanism, which becomes part of file names, has only characters that are
/// safe there.
void check_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (name.size() > kMaxNameLength || !std::ranges::all_of(name, allowed) || name.starts_with('-'))
    throw ConfigError({"", 0, "new mechanism"}, "'" + name + "'",
                      "a name of at most " + std::to_string(kMaxNameLength) + " letters, digits, - and _");
}

std::string mechanism_text(const std::string& given) {
  const std::string name = given.empty() ? "rotary-delta" : given, word = "NAME";
  check_name(name);
  std::string text = kDelta;
  return text.replace(text.find(word), word.size(), name);
}

/// Text of a TOML string, in quotes.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// A comment at the end of a TOML line. Control characters are escaped, so that a text from a mechanism file cannot end
/// the line.
std::string comment(const std::string& text) { return "    # " + printable(text) + '\n'; }

bool is_built_in(const Catalogues& catalogues, const std::string& name) {
  return std::ranges::any_of(catalogues.mechanisms, [&](const auto& m) { return m.name() == name; });
}

/// The line of the table [mechanism] that names the mechanism. The path of a mechanism file is relative to the folder
/// of the study that is written.
std::string mechanism_key(const Catalogues& catalogues, const NewArguments& arguments) {
  if (is_built_in(catalogues, arguments.name)) return "type = " + quoted_toml(arguments.name) + '\n';
  const auto folder_of = [](const std::string& file) { return fs::weakly_canonical(fs::absolute(file).parent_path()); };
  const fs::path here =
      arguments.output.empty() ? fs::weakly_canonical(fs::current_path()) : folder_of(arguments.output);
  const fs::path there = folder_of(arguments.name) / fs::path(arguments.name).filename();
  const std::string path = there.lexically_proximate(here).string();
  if (printable(path) != path)
    throw ConfigError({"", 0, "new study"}, "'" + path + "'", "a path in UTF-8 without control characters");
  return "file = " + quoted_toml(path) + comment("relative to this file");
}

/// Text of a bound of a variable: the value rounded to two significant digits, within the parameter's range.
std::string bound(double value, const Parameter& p) {
  return shortest(std::clamp(std::stod(formatted("%.2g", value)), p.lower, p.upper));
}

/// Parameters that can become variables (positive default value, range not empty), lengths first.
std::vector<const Parameter*> candidates(const std::vector<Parameter>& parameters) {
  std::vector<const Parameter*> all;
  for (const bool length : {true, false})
    for (const Parameter& p : parameters)
      if ((p.unit == "m") == length && p.nominal > 0 && p.lower < p.upper) all.push_back(&p);
  return all;
}

std::vector<const Parameter*> first_few(std::vector<const Parameter*> parameters) {
  parameters.resize(std::min(parameters.size(), kMaxVariables));
  return parameters;
}

std::string study_text(const Catalogues& catalogues, const NewArguments& arguments, const Mechanism& mechanism,
                       const std::vector<const Parameter*>& variables) {
  const MechanismInfo& info = mechanism.info();
  std::string text = "# A study of " + printable(info.name) +
                     " for pkmopt. Check it with 'pkmopt check FILE', run it with 'pkmopt run FILE'.\n";
  text += "[mechanism]\n" + mechanism_key(catalogues, arguments);
  text += "\n[variables]" + comment("parameters that the optimiser varies, and their bounds");
  for (const Parameter* const p : variables) {
    const std::string unit = p->unit == "1" ? "" : "[" + p->unit + "] ";
    text += p->name + " = { min = " + bound(kLowerFactor * p->nominal, *p) +
            ", max = " + bound(kUpperFactor * p->nominal, *p) + " }" +
            comment(unit + (p->meaning.empty() ? p->name : p->meaning));
  }
  text += "\n[workspace]" + comment("counts feasible poses on a grid; more cells are more accurate") +
          "method = \"voxels\"\n";
  std::vector<std::string> cells;
  for (const std::string& name : coordinate_names(info, info.sweeps.front().swept)) cells.push_back(name + " = 24");
  text += "cells = { " + join(cells) + " }\n\n[[objective]]\n";
  if (const Size* const size = mechanism.size())
    text += "type = \"workspace-ratio\"" + comment("volume divided by " + size->meaning());
  else
    text += "type = \"workspace-volume\"\n";
  return text + "\n[[stage]]" + comment("a genetic algorithm") + "optimiser = \"ga\"\ngenerations = 50\n";
}

/// Selects as variables the first candidates that influence the objective: changing only this parameter of the default
/// design to one of the variable's bounds changes the objective. If there is no such candidate, for example because the
/// workspace is empty, selects the first candidates.
std::vector<const Parameter*> influential_variables(const DesignProblem& problem, const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  std::vector<double> design;
  for (const Parameter& p : info.parameters) design.push_back(p.nominal);
  const auto objective = [&] { return mechanism.refuse(design) ? std::nan("") : problem.report(design).objectives[0]; };
  const double default_value = objective();
  const auto all = candidates(info.parameters);
  std::vector<const Parameter*> some;
  for (const Parameter* const p : all) {
    if (some.size() == kMaxVariables) break;
    double& value = design[static_cast<std::size_t>(p - info.parameters.data())];
    const auto changes = [&](double factor) {
      value = std::stod(bound(factor * p->nominal, *p));
      const double changed = objective();
      return !std::isnan(changed) && changed != default_value;
    };
    if (changes(kLowerFactor) || changes(kUpperFactor)) some.push_back(p);
    value = p->nominal;
  }
  return some.empty() ? first_few(all) : some;
}

/// The text of a study. The text is checked by reading it back and evaluating designs; throws ConfigError if that
/// fails, for example because the mechanism has no search box.
std::string default_study(const Catalogues& catalogues, const NewArguments& arguments) {
  const auto mechanism = find_mechanism(catalogues, arguments.name);
  const std::string text =
      study_text(catalogues, arguments, *mechanism, first_few(candidates(mechanism->info().parameters)));
  std::optional<SourceText> description;
  if (!is_built_in(catalogues, arguments.name))
    description = {read_text_file(arguments.name, "a mechanism in TOML"), arguments.name};
  const Study study = read_study_toml(text, "the study", catalogues, description);
  try {
    study.problem->workspace(study.problem->parts().parameters);  // throws if the mechanism has no search box
    return study_text(catalogues, arguments, *mechanism, influential_variables(*study.problem, *mechanism));
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({arguments.name, 0, ""}, reason.what());
  }
}

void write_new(const NewArguments& arguments, const Session& session) {
  const std::vector<std::string> kinds = {"mechanism", "study"};
  expect_file(arguments.kind, "one of " + join(kinds), "new study", session);
  if (std::ranges::find(kinds, arguments.kind) == kinds.end())
    throw ConfigError({"", 0, "new"}, "'" + arguments.kind + "'", "one of " + join(kinds),
                      nearest_name(arguments.kind, kinds));
  const bool study = arguments.kind == "study";
  if (study && arguments.name.empty())
    throw ConfigError({"", 0, "new study"}, "no mechanism", "a mechanism's name or its file");
  const std::string text = study ? default_study(session.catalogues, arguments) : mechanism_text(arguments.name);
  if (arguments.output.empty()) {
    std::cout << text;
    return;
  }
  check_outputs({arguments.output}, {arguments.name}, if_forced(arguments.force));
  write_file(arguments.output, text, if_forced(arguments.force));
  std::cout << "wrote " << arguments.output << '\n'
            << next_step(session, {study ? "run" : "check", file_argument(arguments.output)});
}

}  // namespace

void add_new(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<NewArguments>(
      app, "new", "Create a starter file: a mechanism file or a study.",
      "'new mechanism' writes the file of a rotary Delta robot under the given name, to be edited; 'new study' writes "
      "a\n"
      "study that maximises the workspace of a mechanism, which is built in or described by a mechanism file.\n"
      "Example: pkmopt new mechanism delta -o delta.toml && pkmopt new study delta.toml -o study.toml",
      [&session](const NewArguments& given) { write_new(given, session); });
  add_option(command, "KIND", arguments.kind, "What to create: mechanism or study")->required();
  add_option(command, "NAME", arguments.name,
             "Name of the new mechanism; for a study, the name or file of its mechanism");
  add_option(command, "-o,--output FILE", arguments.output, "Write to this file (default: standard output)");
  command.add_flag("--force", arguments.force, "Overwrite the file if it exists");
}

}  // namespace pkm
