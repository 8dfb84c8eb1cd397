// `pkmopt new`: creates a commented starter file, either a mechanism file or a study of a mechanism.

#include <algorithm>
#include <iostream>

#include "engine/storage/safe_file.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/starter_study.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

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

void write_new(const NewArguments& arguments, const Session& session) {
  const std::vector<std::string> kinds = {"mechanism", "study"};
  expect_file(arguments.kind, "one of " + join(kinds), "new study", session);
  if (std::ranges::find(kinds, arguments.kind) == kinds.end())
    throw ConfigError({"", 0, "new"}, "'" + arguments.kind + "'", "one of " + join(kinds),
                      nearest_name(arguments.kind, kinds));
  const bool study = arguments.kind == "study";
  if (study && arguments.name.empty())
    throw ConfigError({"", 0, "new study"}, "no mechanism", "a mechanism's name or its file");
  const std::string text =
      study ? starter_study(session.catalogues, arguments.name, arguments.output) : mechanism_text(arguments.name);
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
      "study that maximises the workspace of a mechanism, which is built in or described by a mechanism file: by "
      "exact\n"
      "columns with a gradient solver if they are quick, otherwise by voxels. It has a commented example of each kind "
      "of\n"
      "constraint that the mechanism supports.\n"
      "Example: pkmopt new mechanism delta -o delta.toml && pkmopt new study delta.toml -o study.toml",
      [&session](const NewArguments& given) { write_new(given, session); });
  add_option(command, "KIND", arguments.kind, "What to create: mechanism or study")->required();
  add_option(command, "NAME", arguments.name,
             "Name of the new mechanism; for a study, the name or file of its mechanism");
  add_option(command, "-o,--output FILE", arguments.output, "Write to this file (default: standard output)");
  command.add_flag("--force", arguments.force, "Overwrite the file if it exists");
}

}  // namespace pkm
