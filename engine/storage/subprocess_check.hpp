// Parses an untrusted study file in a subprocess before this process parses it. HDF5 1.10 can crash, loop or exhaust
// the memory on malformed data even if their checksum is right, which would end a run, a rank or a user's interpreter.
// The subprocess is a new program with limits on memory and time (spawned, because fork is not safe in a process with
// threads). It parses exactly the bytes that the caller parses afterwards.
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// Sets the command line of the checking process, which reads the file from its standard input. Must be called before
/// threads start; program_main() sets it to the program itself. By default the command is empty and read_study() parses
/// without this check, as is appropriate for programs that read only their own files.
void set_check_command(std::vector<std::string> command);

/// Runs the checking process on the bytes of a file whose header has been verified. Throws ImageError if the process
/// finds that they do not follow the schema, StorageError if it crashes, exceeds its limits or cannot be started.
/// @param path  path of the file, for messages
void check_in_subprocess(const std::string& bytes, const std::string& path);

/// The main function of the checking process: sets its limits, parses standard input as a study and prints the reason
/// to standard output if it is invalid.
/// @return the exit code of the process
int check_study_on_standard_input();

}  // namespace pkm
