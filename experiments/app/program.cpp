#include "experiments/app/program.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "constraints/all.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/mechanisms/all.hpp"
#include "experiments/app/command_line.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/version.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

std::string version() {
  return program_words() + "\ninstruction set: " + std::string(name_of(instruction_set())) + " of " +
         join({kInstructionSets.begin(), kInstructionSets.end()});
}

/// For comparisons: results are the same on all.
void add_instruction_set(CLI::App& command) {
  const auto choose = [](const std::string& name) {
    const std::vector<std::string> known{kInstructionSets.begin(), kInstructionSets.end()};
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw ConfigError({"", 0, "--instruction-set"}, "'" + name + "'", "one of " + join(known),
                        nearest_name(name, known));
    try {
      use_instruction_set(static_cast<InstructionSet>(found - known.begin()));
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, "--instruction-set"}, reason.what());
    }
  };
  command
      .add_option_function<std::string>("--instruction-set", choose,
                                        "Vector instructions to use (default: the widest that the processor has); "
                                        "changes the speed, never a result")
      ->type_name("SET");
}

void run(const std::vector<std::string>& arguments, Session& session) {
  CLI::App app("Design-space optimisation of parallel kinematic machines.", session.program);
  app.set_version_flag("--version", version());
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.require_subcommand(1);
  app.footer(
      "'pkmopt COMMAND --help' tells more of a command. Numbers are SI (m, rad, s) or carry a unit: x=200mm.\n"
      "Exit codes: 0 done, 1 failure, 2 bad input, 3 stopped early with a checkpoint to go on from.\n"
      "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml");
  add_run(app, session);
  add_resume(app, session);
  add_check(app, session);
  add_evaluate(app, session);
  add_pose(app, session);
  add_forward(app, session);
  add_dynamics(app, session);
  add_coupling(app, session);
  add_trajectory(app, session);
  add_simulate(app, session);
  add_workspace(app, session);
  add_show(app, session);
  add_report(app, session);
  add_export(app, session);
  add_list(app, session);
  for (const char* name : {"run", "resume", "evaluate", "coupling"}) add_instruction_set(*app.get_subcommand(name));
  if (!parse_command_line(app, arguments)) return;
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("the results cannot be written to the standard output");
}

}  // namespace

Catalogues all_catalogues() { return {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()}; }

int program_main(int argc, char** argv, const Catalogues& catalogues) {
  const std::string name = argc > 0 ? std::filesystem::path(argv[0]).stem().string() : "";
  Session session{catalogues, name.empty() ? "pkmopt" : name};
  const auto complain = [&session](const std::string& sentence, int exit_code) {
    std::cerr << session.program << ": " << sentence << '\n';
    return exit_code;
  };
  try {
    run({argv + std::min(argc, 1), argv + argc}, session);
    return session.exit_code;
  } catch (const ConfigError& error) {
    return complain(error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", kFailure);
  } catch (const std::exception& error) {
    return complain(error.what(), kFailure);
  }
}

}  // namespace pkm
