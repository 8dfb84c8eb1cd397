// The program's subcommands: one function each, which declares the command's options and the function that runs it.
//
// To add a command, write a file of its own and add its name here and in program.cpp. A command throws ConfigError for
// invalid input and any other exception for other failures; program_main turns both into one sentence on stderr and an
// exit code.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "engine/config/study.hpp"
#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"

namespace pkm {

// Exit codes of the program.
inline constexpr int kDone = 0;
inline constexpr int kFailure = 1;
inline constexpr int kBadInput = 2;
/// Exit code: the study was stopped after writing a checkpoint, and 'pkmopt resume' can continue it.
inline constexpr int kStoppedEarly = 3;
/// Exit code: the study is complete without a feasible design, or it provably has none.
inline constexpr int kNothingFeasible = 4;

/// Data that every command receives; a command also sets its exit code here.
struct Session {
  const Catalogues& catalogues;
  /// Name under which the program was called: "pkmopt", or the name of a program built with the library.
  std::string program;
  std::string arguments = {};  ///< the command line without the program name, quoted for a shell
  int exit_code = kDone;
};

/// Prints the sentence `step` to stderr if the returned object still exists after 1 s (on a terminal) or 10 s
/// (elsewhere).
SlowStepNotice announce_slow_step(const Session& session, const std::string& step);

/// Declares an option or a positional argument. `words` is its name with the placeholder of its value, "--csv FILE", or
/// the placeholder of an argument, "STUDY.toml".
template <class Value>
CLI::Option* add_option(CLI::App& command, const std::string& words, Value& value, const std::string& meaning) {
  const auto name_end = std::min(words.find(' '), words.size());
  const auto type = name_end < words.size() ? words.substr(name_end + 1) : "";
  CLI::Option* const option = command.add_option(words.substr(0, name_end), value, meaning)->type_name(type);
  if constexpr (std::is_same_v<Value, std::string>)
    option->each([option, type](const std::string& given) {
      if (given.empty()) throw ConfigError({"", 0, option->get_name()}, "the value is empty");
      const bool names_file = type.starts_with("F.") || type.ends_with("FILE") || type == "DIR";
      if (names_file && given.starts_with('-'))
        throw ConfigError({"", 0, option->get_name()}, "'" + given + "'",
                          "a file name (write './" + given + "' for this file)");
    });
  return option;
}

/// Parses the value of an option as a decimal integer. Throws ConfigError if it is not an integer in [lower, upper].
std::int64_t parse_option(const std::string& text, const std::string& option, std::int64_t lower, std::int64_t upper);

/// Declares an option whose value is an integer in [lower, upper].
/// @param value  receives the value: an integer or an optional integer
template <class Integer>
CLI::Option* add_integer(CLI::App& command, const std::string& words, Integer& value, std::int64_t lower,
                         std::int64_t upper, const std::string& meaning) {
  const auto name_end = words.find(' ');
  const std::string name = words.substr(0, name_end);
  const auto read = [&value, name, lower, upper](const std::string& text) {
    value = static_cast<Integer>(parse_option(text, name, lower, upper));
  };
  const bool bounded = upper < std::numeric_limits<std::int64_t>::max();
  const std::string range = bounded ? ":INT in [" + std::to_string(lower) + " - " + std::to_string(upper) + "]" : "";
  return command.add_option_function<std::string>(name, read, meaning)->type_name(words.substr(name_end + 1) + range);
}

/// Adds a subcommand, which calls `run` with its parsed arguments. The caller declares the options of the subcommand.
template <class Arguments, class Run>
std::pair<CLI::App&, Arguments&> add_command(CLI::App& app, const std::string& name, const std::string& meaning,
                                             const std::string& footer, Run run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(name, meaning)->footer(footer);
  command->callback([arguments, run] { run(*arguments); });
  return {*command, *arguments};
}

/// Type of the functions that add one subcommand to `app`. `session` must outlive the parsing of the command line.
using AddCommand = void(CLI::App& app, Session& session);
AddCommand add_run, add_resume, add_check, add_evaluate, add_sensitivity, add_pose, add_forward, add_dynamics,
    add_coupling, add_trajectory, add_simulate, add_workspace, add_connect, add_certify, add_tolerances, add_compare,
    add_show, add_report, add_export, add_generate, add_list, add_new, add_schema, add_upgrade, add_completion,
    add_manual;
void add_all_commands(CLI::App& app, Session& session);

/// Text that states what stopped a command, and the exit code: "SIGINT (Ctrl-C), exit code 3".
std::string stop_words(const std::string& cause);

inline constexpr const char* kProgramMeaning = "Design-space optimisation of parallel kinematic machines.";
inline constexpr const char* kProgramNotes =
    "See 'pkmopt help COMMAND' for the options of a command. Numbers are SI (m, rad, s) or carry a unit: x=200mm.\n"
    "Exit codes: 0 done, 1 failure, 2 bad input, 3 stopped early with a checkpoint, 4 nothing feasible.\n"
    "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml";

}  // namespace pkm
