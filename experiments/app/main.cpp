// pkmopt: the command-line program.

#include <algorithm>
#include <exception>
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

namespace {

int complain(const std::string& sentence, int exit_code) {
  std::cerr << "pkmopt: " << sentence << '\n';
  return exit_code;
}

std::string version() {
  return pkm::program_words() + "\ninstruction set: " + std::string(name_of(pkm::instruction_set())) + " of " +
         pkm::join({pkm::kInstructionSets.begin(), pkm::kInstructionSets.end()});
}

/// For comparisons: results are the same on all.
void add_instruction_set(CLI::App& command) {
  const auto choose = [](const std::string& name) {
    const std::vector<std::string> known{pkm::kInstructionSets.begin(), pkm::kInstructionSets.end()};
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw pkm::ConfigError({"", 0, "--instruction-set"}, "'" + name + "'", "one of " + pkm::join(known),
                             pkm::nearest_name(name, known));
    try {
      pkm::use_instruction_set(static_cast<pkm::InstructionSet>(found - known.begin()));
    } catch (const std::invalid_argument& reason) {
      throw pkm::ConfigError({"", 0, "--instruction-set"}, reason.what());
    }
  };
  command
      .add_option_function<std::string>("--instruction-set", choose,
                                        "Vector instructions to use (default: the widest that the processor has); "
                                        "changes the speed, never a result")
      ->type_name("SET");
}

int run(int argc, char** argv) {
  pkm::Session session{{pkm::all_mechanisms(), pkm::all_objectives(), pkm::all_constraints(), pkm::all_optimisers()}};
  CLI::App app("Design-space optimisation of parallel kinematic machines.", "pkmopt");
  app.set_version_flag("--version", version());
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.require_subcommand(1);
  app.footer(
      "'pkmopt COMMAND --help' tells more of a command. Numbers are SI (m, rad, s) or carry a unit: x=200mm.\n"
      "Exit codes: 0 done, 1 failure, 2 bad input, 3 stopped early with a checkpoint to go on from.\n"
      "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml");
  pkm::add_run(app, session);
  pkm::add_resume(app, session);
  pkm::add_check(app, session);
  pkm::add_evaluate(app, session);
  pkm::add_pose(app, session);
  pkm::add_forward(app, session);
  pkm::add_dynamics(app, session);
  pkm::add_coupling(app, session);
  pkm::add_trajectory(app, session);
  pkm::add_simulate(app, session);
  pkm::add_workspace(app, session);
  pkm::add_show(app, session);
  pkm::add_report(app, session);
  pkm::add_export(app, session);
  pkm::add_list(app, session);
  for (const char* name : {"run", "resume", "evaluate", "coupling"}) add_instruction_set(*app.get_subcommand(name));
  if (!pkm::parse_command_line(app, {argv + 1, argv + argc})) return pkm::kDone;
  std::cout.flush();
  if (!std::cout) return complain("the results cannot be written to the standard output", pkm::kFailure);
  return session.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const pkm::ConfigError& error) {
    return complain(error.what(), pkm::kBadInput);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", pkm::kFailure);
  } catch (const std::exception& error) {
    return complain(error.what(), pkm::kFailure);
  }
}
