// The declared commands and options as data, from which shell completion and manual pages are generated.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/commands.hpp"

namespace pkm {

/// An option, or a positional argument, of a command.
struct DeclaredOption {
  std::string name;        ///< name of the option, for example "--output"; for an argument, its placeholder
  std::string short_name;  ///< one-letter form of the option, for example "-o"; "": none
  std::string type;        ///< placeholder of the value, for example "F.h5"; "": the option has no value
  std::string meaning;
  bool required = false;
};

struct DeclaredCommand {
  std::string name, meaning, footer;
  std::vector<DeclaredOption> options, arguments;
};

/// All commands with their options and arguments.
std::vector<DeclaredCommand> declared_commands(Session& session);

/// Names of the shells for which completion is available.
std::vector<std::string> shells();

/// Joins words to one text, separated by spaces.
std::string join_words(const std::vector<std::string>& words);

}  // namespace pkm
