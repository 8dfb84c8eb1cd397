// `pkmopt new`: a file to begin with, commented: the description of a mechanism, or a study of one.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"
#include "engine/setup/text_file.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostVariables = 4;
constexpr double kBelow = 0.8, kAbove = 1.25;  // a variable's bounds over the default
constexpr std::size_t kLongestName = 60;

struct NewArguments {
  std::string kind, name, output;
  bool force = false;
};

constexpr const char* kDelta =
    R"toml(# A mechanism, for pkmopt: 'pkmopt check FILE' tells what is understood of it and what it can.
[mechanism]
name   = "NAME"
title  = "three cranks, three pairs of rods, three translations"
source = "Clavel 1988"

[parameters]             # whatever an optimiser may change; the unit is the default's
R     = { default = "200 mm", min = "10 mm", max = "2 m", meaning = "radius of the cranks' pivots" }
r     = { default = "50 mm", min = "1 mm", max = "1 m", meaning = "radius of the platform's joints" }
l_a   = { default = "200 mm", min = "10 mm", max = "2 m", meaning = "length of a crank" }
l_b   = { default = "500 mm", min = "10 mm", max = "4 m", meaning = "length of a rod" }
q_min = { default = "-40 deg", min = "-180 deg", max = "180 deg", meaning = "least crank angle" }
q_max = { default = "95 deg", min = "-180 deg", max = "180 deg", meaning = "greatest crank angle" }

[platform]               # its freedoms: translations, and rotations "about x", ..
coordinates = { x = "along x", y = "along y", z = "along z" }
characteristic_length = "r"                # where the two are weighed against each other

[survey]                 # where a study looks that gives no box: formulas of the parameters
box = { x = ["-(R+l_a+l_b)", "R+l_a+l_b"], y = ["-(R+l_a+l_b)", "R+l_a+l_b"], z = ["-(l_a+l_b)", 0] }

[[limb]]                 # each is solved by itself, the platform's pose being given
name     = "arm"
copies   = { number = 3, about = "z" }     # arm1, arm2, arm3
drive    = "crank"                         # or telescope, slider, formula
base     = ["R", 0, 0]                     # the crank's pivot, in the frame of the base
axis     = [0, 1, 0]                       # of the pivot
zero     = [1, 0, 0]                       # direction of the crank at angle 0
crank    = "l_a"
rod      = "l_b"
platform = ["r", 0, 0]                     # the rod's end, in the frame of the platform
branch   = "-"                             # elbows outwards; "+": inwards
range    = ["q_min", "q_max"]
pair     = { spacing = "60 mm" }           # two rods side by side keep the platform from turning
radius   = "6 mm"                          # for clearance and drawings

[[design]]               # what has to hold of a design before any pose is looked at
name    = "rods longer than cranks"
formula = "l_b - l_a"                      # >= 0 holds
unit    = "m"
)toml";

/// A mechanism's name is part of file names, too.
void check_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (name.size() > kLongestName || !std::ranges::all_of(name, allowed) || name.starts_with('-'))
    throw ConfigError({"", 0, "new mechanism"}, "'" + name + "'",
                      "a name of at most " + std::to_string(kLongestName) + " letters, digits, - and _");
}

std::string mechanism_text(const std::string& given) {
  const std::string name = given.empty() ? "rotary-delta" : given, word = "NAME";
  check_name(name);
  std::string text = kDelta;
  return text.replace(text.find(word), word.size(), name);
}

/// Text in TOML.
std::string quoted_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// Behind a key; whatever a description says, it stays on the line.
std::string comment(const std::string& text) { return "    # " + printable(text) + '\n'; }

bool is_built_in(const Catalogues& catalogues, const std::string& name) {
  return std::ranges::any_of(catalogues.mechanisms, [&](const auto& m) { return m->info().name == name; });
}

/// The key of [mechanism], as a study in that file has to write it.
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

/// A bound of a variable: two digits, within the parameter's range.
std::string bound(double value, const Parameter& p) {
  return shortest(std::clamp(std::stod(formatted("%.2g", value)), p.lower, p.upper));
}

/// Parameters that can vary, lengths first.
std::vector<const Parameter*> candidates(const std::vector<Parameter>& parameters) {
  std::vector<const Parameter*> all;
  for (const bool length : {true, false})
    for (const Parameter& p : parameters)
      if ((p.unit == "m") == length && p.nominal > 0 && p.lower < p.upper) all.push_back(&p);
  return all;
}

std::vector<const Parameter*> first_few(std::vector<const Parameter*> parameters) {
  parameters.resize(std::min(parameters.size(), kMostVariables));
  return parameters;
}

std::string study_text(const Catalogues& catalogues, const NewArguments& arguments, const Mechanism& mechanism,
                       const std::vector<const Parameter*>& variables) {
  const MechanismInfo& info = mechanism.info();
  std::string text = "# A study of " + printable(info.name) + ", for pkmopt: 'pkmopt check FILE', 'pkmopt run FILE'.\n";
  text += "[mechanism]\n" + mechanism_key(catalogues, arguments);
  text += "\n[variables]" + comment("what the optimiser may change");
  for (const Parameter* const p : variables) {
    const std::string unit = p->unit == "1" ? "" : "[" + p->unit + "] ";
    text += p->name + " = { min = " + bound(kBelow * p->nominal, *p) + ", max = " + bound(kAbove * p->nominal, *p) +
            " }" + comment(unit + (p->meaning.empty() ? p->name : p->meaning));
  }
  text += "\n[workspace]" + comment("poses on a grid; more cells are more exact") + "method = \"voxels\"\n";
  std::vector<std::string> cells;
  for (const std::string& name : coordinate_names(info, info.sweeps.front().swept)) cells.push_back(name + " = 24");
  text += "cells = { " + join(cells) + " }\n\n[[objective]]\n";
  if (const Size* const size = mechanism.size())
    text += "type = \"workspace-ratio\"" + comment("volume over " + size->meaning());
  else
    text += "type = \"workspace-volume\"\n";
  return text + "\n[[stage]]" + comment("a genetic algorithm") + "optimiser = \"ga\"\ngenerations = 50\n";
}

/// The first candidates of which a bound changes the objective of the default design; where none does, as of one
/// without a workspace, the first.
std::vector<const Parameter*> usual_variables(const DesignProblem& problem, const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  std::vector<double> design;
  for (const Parameter& p : info.parameters) design.push_back(p.nominal);
  const auto objective = [&] { return mechanism.refuse(design) ? std::nan("") : problem.report(design).objectives[0]; };
  const double usual = objective();
  const auto all = candidates(info.parameters);
  std::vector<const Parameter*> some;
  for (const Parameter* const p : all) {
    if (some.size() == kMostVariables) break;
    double& value = design[static_cast<std::size_t>(p - info.parameters.data())];
    const auto changes = [&](double factor) {
      value = std::stod(bound(factor * p->nominal, *p));
      const double other = objective();
      return !std::isnan(other) && other != usual;
    };
    if (changes(kBelow) || changes(kAbove)) some.push_back(p);
    value = p->nominal;
  }
  return some.empty() ? first_few(all) : some;
}

/// The study, after it has been read and a few of its designs have been evaluated. Throws ConfigError where that cannot
/// be done, as of a mechanism without a box.
std::string usual_study(const Catalogues& catalogues, const NewArguments& arguments) {
  const auto mechanism = find_mechanism(catalogues, arguments.name);
  const std::string text =
      study_text(catalogues, arguments, *mechanism, first_few(candidates(mechanism->info().parameters)));
  std::optional<SourceText> description;
  if (!is_built_in(catalogues, arguments.name))
    description = {read_text_file(arguments.name, "a mechanism in TOML"), arguments.name};
  const Study study = read_study_toml(text, "the study", catalogues, description);
  try {
    study.problem->workspace(study.problem->parts().parameters);  // throws where there is no box
    return study_text(catalogues, arguments, *mechanism, usual_variables(*study.problem, *mechanism));
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
  const std::string text = study ? usual_study(session.catalogues, arguments) : mechanism_text(arguments.name);
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
      app, "new", "A file to begin with: a mechanism's description, or a study.",
      "'new mechanism' describes a rotary Delta under the name given, to be changed into another robot; 'new study'\n"
      "looks for the largest workspace of a mechanism, built in or described by a file.\n"
      "Example: pkmopt new mechanism delta -o delta.toml && pkmopt new study delta.toml -o study.toml",
      [&session](const NewArguments& given) { write_new(given, session); });
  add_option(command, "KIND", arguments.kind, "mechanism or study")->required();
  add_option(command, "NAME", arguments.name, "mechanism: its name; study: of which mechanism, a name or a file");
  add_option(command, "-o,--output FILE", arguments.output, "Write this file (default: print)");
  command.add_flag("--force", arguments.force, "Overwrite the file if it exists");
}

}  // namespace pkm
