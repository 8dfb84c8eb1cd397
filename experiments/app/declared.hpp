// The command line as data, for what is made from its declarations: completion and manual pages.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/commands.hpp"

namespace pkm {

/// An option or an argument.
struct DeclaredOption {
  std::string name;    ///< "--output"; of an argument its type
  std::string letter;  ///< "-o"; "": none
  std::string type;    ///< what its value is: "F.h5"; "": it takes none
  std::string meaning;
  bool required = false;
};

struct DeclaredCommand {
  std::string name, meaning, footer;
  std::vector<DeclaredOption> options, arguments;
};

/// Every command with everything that it takes.
std::vector<DeclaredCommand> declared_commands(Session& session);

/// Those that completion knows.
std::vector<std::string> shells();

/// Words with blanks between them.
std::string join_words(const std::vector<std::string>& words);

}  // namespace pkm
