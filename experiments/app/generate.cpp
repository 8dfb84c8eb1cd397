// `pkmopt generate`: writes the kinematics and dynamics of a design as code for controllers and simulations.

#include <filesystem>

#include "engine/core/catalogue.hpp"
#include "engine/export/code/languages.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/target.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct GenerateArguments : DesignArguments, ModeArguments {
  std::string language, folder;
  bool parameters = false, single_precision = false, force = false;
  std::size_t poses = 20;
};

struct Language {
  std::string name;
  std::vector<code::File> (*files)(const code::Module&);
};

const std::vector<Language>& languages() {
  static const std::vector<Language> list = {
      {"c", code::c_files}, {"cpp", code::cpp_files}, {"python", code::python_files}, {"matlab", code::matlab_files}};
  return list;
}

std::string generate(const Target& target, const GenerateArguments& arguments, Printout& out) {
  const std::vector<std::string> names = names_of(languages());
  const Language* const language = find_named(languages(), arguments.language);
  if (!language)
    throw ConfigError({"", 0, "--language"}, "'" + arguments.language + "'", "one of " + join(names),
                      nearest_name(arguments.language, names));
  if (arguments.single_precision && !arguments.language.starts_with("c"))
    throw ConfigError({"", 0, "--float"}, "--language " + arguments.language, "c or cpp");
  const std::string mode = parse_mode(target.info(), arguments);
  const code::Options options{arguments.parameters, arguments.single_precision, arguments.poses};
  const std::string title = target.info().name + ", " + (arguments.parameters ? "any design" : target.words) + ", " +
                            mode + "; written by " + program_words();
  std::vector<code::File> files;
  try {
    files = language->files(code::module_of(*target.mechanism, target.parameters, target.limits, mode, options, title));
  } catch (const DesignError&) {
    throw;
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
  std::vector<std::string> paths;
  for (const code::File& file : files) paths.push_back((std::filesystem::path(arguments.folder) / file.name).string());
  check_outputs(paths, target.files, if_forced(arguments.force));
  for (std::size_t i = 0; i < files.size(); ++i) {
    create_folder(std::filesystem::path(paths[i]).parent_path().string());
    write_file(paths[i], files[i].text, if_forced(arguments.force));
    out.json["files"].push_back(paths[i]);
    out.text += "wrote " + paths[i] + "\n";
  }
  return "";
}

}  // namespace

void add_generate(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<GenerateArguments>(
      app, session, "generate", "Write kinematics and dynamics of a design as code in C, C++, Python or MATLAB.",
      "The code needs no libraries: inverse kinematics, Jacobian, margins, quantities, forward kinematics by Newton's\n"
      "method, and with masses the equations of motion and drive forces. A test with values of pkmopt is written, "
      "too.\n"
      "Example: pkmopt generate 4ppa-2par --language c --set a=0.3 -o code",
      generate);
  add_option(command, "--language LANGUAGE", arguments.language, "c, cpp, python or matlab (also for Octave)")
      ->required();
  add_option(command, "-o,--output DIR", arguments.folder, "Folder for the files")->required();
  add_mode_options(command, arguments);
  command.add_flag("--parameters", arguments.parameters,
                   "Take the parameters as an argument of every function, instead of those of the design as constants");
  command.add_flag("--float", arguments.single_precision, "Use single precision (c, cpp)");
  add_integer(command, "--test-poses N", arguments.poses, 1, 100'000, "Number of poses of the test (default: 20)");
  command.add_flag("--force", arguments.force, "Overwrite files that exist");
}

}  // namespace pkm
