// What a user types next, or meant to type.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/commands.hpp"

namespace pkm {

/// A word as a shell takes it, in quotes where it needs them.
std::string quoted(const std::string& word);

/// The name of a file as an argument: "./-x.h5" for one that would be taken for an option.
std::string file_argument(const std::string& file);

/// "pkmopt run a.toml": the program with words that are quoted where they need it.
std::string command_text(const Session& session, const std::vector<std::string>& words);

/// "next: pkmopt report a.h5\n"
std::string next_step(const Session& session, const std::vector<std::string>& words);

/// Throws ConfigError for the name of a built-in mechanism where there has to be a file or a kind of file.
/// @param wanted   what is expected
/// @param instead  the command that takes the name, without the program's name
void expect_file(const std::string& word, const std::string& wanted, const std::string& instead,
                 const Session& session);
/// Throws ConfigError for a file in TOML where a study file is read.
/// @param instead  the command that takes it, without the program's name and the file's
void expect_study_file(const std::string& file, const std::string& instead, const Session& session);
/// Throws ConfigError for a study file where one in TOML is read.
void expect_toml(const std::string& file, const std::string& instead, const Session& session);

}  // namespace pkm
