// Parsing of the command line, with messages in the words of all our other errors.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pkm {

/// Parses `arguments` (without the program's name) and runs the chosen subcommand. False: help or the version was asked
/// for and has been printed. Throws ConfigError for a command line that is wrong, naming the nearest known word.
bool parse_command_line(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace pkm
