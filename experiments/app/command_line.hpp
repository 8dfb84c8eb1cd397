// Parses the command line with CLI11; errors are reported in the common form of ConfigError.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pkm {

/// Parses `arguments` and runs the selected subcommand, or prints the help or the version if an argument requests it.
/// Throws ConfigError with the closest valid word for an invalid command line.
/// @param arguments  at least one; without the program's name
void parse_command_line(CLI::App& app, const std::vector<std::string>& arguments);

/// Replaces "pkmopt" in a help text by the name of a program that a user has built with the library.
std::string with_program_name(std::string help, const std::string& name);

}  // namespace pkm
