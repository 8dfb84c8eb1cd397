// Parses the command line with CLI11; errors are reported in the common form of ConfigError.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pkm {

/// Parses `arguments` (without the program's name; at least one) and runs the chosen subcommand, or prints the help or
/// the version if requested. Throws ConfigError for an invalid command line, with the closest valid word.
void parse_command_line(CLI::App& app, const std::vector<std::string>& arguments);

/// Replaces "pkmopt" in a help text by the name of a user's own program.
std::string with_program_name(std::string help, const std::string& name);

}  // namespace pkm
