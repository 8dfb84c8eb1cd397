// Study files that others may have made are parsed once by a process of its own before this one parses them: HDF5 1.10
// can crash, run on or ask for all memory on data whose checksum is right, and would take a run, a rank or a user's
// interpreter with it. The helper is a new program (spawned, never a fork that goes on in copied threads), with limits
// of memory and time; it reads the very bytes that the caller goes on with.
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// The helper's command line; its standard input is the file. None: read_study parses unchecked, for programs that read
/// their own files only. Set before threads begin; program_main sets it to itself.
void use_file_checker(std::vector<std::string> command);

/// Runs the helper on a file's bytes, whose seal is right. Throws ImageError where it finds them not laid out as a
/// study, StorageError where it crashes or does not come to an end.
void check_contained(const std::string& bytes, const std::string& path);

/// What the helper does: parses its standard input as a study and returns the exit code, under limits that it sets
/// itself. The reason for a refusal goes to the standard output.
int check_standard_input();

}  // namespace pkm
