// Parsing of the command line, with messages in the words of all our other errors.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pkm {

/// Parses `arguments` (without the program's name; at least one) and runs the chosen subcommand, or prints help or the
/// version where these are asked for. Throws ConfigError for a command line that is wrong, naming the nearest known
/// word.
void parse_command_line(CLI::App& app, const std::vector<std::string>& arguments);

/// Our help under the name of a user's own program.
std::string with_name(std::string help, const std::string& name);

}  // namespace pkm
