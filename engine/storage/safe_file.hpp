// Whole files, written so that a crash at any instant leaves the old or the new one, and nothing in between. Every file
// that the program writes is written here.
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// What becomes of a file that has the name already.
enum class Existing { refused, replaced };

/// By the flag --force.
inline Existing if_forced(bool force) { return force ? Existing::replaced : Existing::refused; }

/// What `path` stands for: the file behind a symbolic link, which need not exist, or `path` itself. Throws StorageError
/// when links go round in circles, and for a name with a NUL, behind which the system would not look.
std::string link_target(const std::string& path);

/// To be asked before work is begun. Throws ConfigError when an output is also one of the inputs, by whatever name, or
/// when two are the same file, and StorageError when one exists and may not be replaced. Empty names are none.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, Existing existing);

/// Writes `bytes` to a new file of a random name in the same folder, reads them back, syncs, gives it the name `path`,
/// syncs the folder. Throws StorageError with the system's reason; then `path` is as it was and the temporary file is
/// gone. A symbolic link stays, and what it points to is replaced; what is replaced hands on its permissions; what
/// exists and is no regular file (a folder, a device) is refused.
void write_file(const std::string& path, const std::string& bytes, Existing existing);

/// Throws StorageError with the system's reason.
/// @param most  bytes to read from its beginning
std::string read_file(const std::string& path, std::size_t most = std::string::npos);

}  // namespace pkm
