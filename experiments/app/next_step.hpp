// Suggests the next command to type, and the command that was probably meant where a file of the wrong kind is given.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/commands.hpp"

namespace pkm {

/// Quotes a word for a POSIX shell, if it needs quotes.
std::string quoted(const std::string& word);

/// A file name as a command-line argument: "./-x.h5" for a name that would be parsed as an option.
std::string file_argument(const std::string& file);

/// A command line of this program as text, quoted for the shell: "pkmopt run a.toml".
std::string command_text(const Session& session, const std::vector<std::string>& words);

/// Text that suggests the next command: "next: pkmopt report a.h5\n".
std::string next_step(const Session& session, const std::vector<std::string>& words);

/// Throws ConfigError if `word` is the name of a built-in mechanism and not of a file.
/// @param expected     what the command expects, for the message
/// @param alternative  the command that accepts the name, without the program's name
void expect_file(const std::string& word, const std::string& expected, const std::string& alternative,
                 const Session& session);
/// Throws ConfigError if `file` is a TOML file or the name of a mechanism, for a command that reads a study file.
/// @param alternative  the command that accepts the TOML file, without the names of program and file
void expect_study_file(const std::string& file, const std::string& alternative, const Session& session);
/// Throws ConfigError if `file` is a study file, for a command that reads a TOML file.
/// @param alternative  the command that accepts the study file
void expect_toml(const std::string& file, const std::string& alternative, const Session& session);

}  // namespace pkm
