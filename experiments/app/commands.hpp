// The program's subcommands: one function each, which declares the command line and says what runs when it is chosen.
//
// To add one: a file of its own, its name here and in program.cpp. A command reports bad input by
// ConfigError and everything else by another exception; program_main turns both into one sentence on stderr and an exit
// code.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/setup/study.hpp"

namespace pkm {

// What the program's exit code says.
inline constexpr int kDone = 0;
inline constexpr int kFailure = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kStoppedEarly = 3;     ///< with a checkpoint to go on from
inline constexpr int kNothingFeasible = 4;  ///< the study has ended, or cannot end otherwise; its file is complete

/// What every command is given, and gives back.
struct Session {
  const Catalogues& catalogues;
  std::string program;         ///< as it was called: "pkmopt", or the name of a user's own
  std::string arguments = {};  ///< the command line's, on one line
  int exit_code = kDone;
};

/// While it lives: a line on stderr says that a step takes long, after a second on a terminal, elsewhere after ten.
SlowStep announced(const Session& session, const std::string& step);

/// Declares an option with a word for its value, "--csv FILE", or an argument by what stands for it: "STUDY.toml".
template <class Value>
CLI::Option* add_option(CLI::App& command, const std::string& words, Value& value, const std::string& meaning) {
  const auto name_end = std::min(words.find(' '), words.size());
  const auto type = name_end < words.size() ? words.substr(name_end + 1) : "";
  CLI::Option* const option = command.add_option(words.substr(0, name_end), value, meaning)->type_name(type);
  if constexpr (std::is_same_v<Value, std::string>)
    option->each([option, type](const std::string& given) {
      if (given.empty())
        throw ConfigError({"", 0, option->get_name()}, "an empty text where there has to be something");
      const bool names_file = type.starts_with("F.") || type.ends_with("FILE") || type == "DIR";
      if (names_file && given.starts_with('-'))
        throw ConfigError({"", 0, option->get_name()}, "'" + given + "'",
                          "a name; './" + given + "' is a file so called");
    });
  return option;
}

/// The whole number of an option, in decimal, within [lower, upper]. Throws ConfigError.
std::int64_t parse_option(const std::string& text, const std::string& option, std::int64_t lower, std::int64_t upper);

/// Declares an option that takes a whole number within [lower, upper], into an integer or an optional one.
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

/// Adds a subcommand that does `run` with its arguments; the caller declares these.
template <class Arguments, class Run>
std::pair<CLI::App&, Arguments&> add_command(CLI::App& app, const std::string& name, const std::string& meaning,
                                             const std::string& footer, Run run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(name, meaning)->footer(footer);
  command->callback([arguments, run] { run(*arguments); });
  return {*command, *arguments};
}

/// Adds a subcommand to `app`. `session` must outlive the parsing of the command line.
using AddCommand = void(CLI::App& app, Session& session);
AddCommand add_run, add_resume, add_check, add_evaluate, add_pose, add_forward, add_dynamics, add_coupling,
    add_trajectory, add_simulate, add_workspace, add_certify, add_show, add_report, add_export, add_list, add_new,
    add_completion, add_manual;
void add_all_commands(CLI::App& app, Session& session);

inline constexpr const char* kProgramMeaning = "Design-space optimisation of parallel kinematic machines.";
inline constexpr const char* kProgramNotes =
    "'pkmopt COMMAND --help' tells more of a command. Numbers are SI (m, rad, s) or carry a unit: x=200mm.\n"
    "Exit codes: 0 done, 1 failure, 2 bad input, 3 stopped early with a checkpoint to go on from, 4 nothing "
    "feasible.\n"
    "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml";

}  // namespace pkm
