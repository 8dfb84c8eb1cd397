// Atomic file replacement: write to a temporary file, fsync, rename. After a crash at any instant either the old or the
// new file is complete. All files that the program writes are written by write_file().
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// What to do if the output file already exists: report an error, or replace it.
enum class Existing { refused, replaced };

/// The policy for existing files that the command-line flag --force selects.
inline Existing if_forced(bool force) { return force ? Existing::replaced : Existing::refused; }

/// Resolves symbolic links. Throws StorageError for circular links, and for a path that contains a NUL character,
/// because the system calls would ignore the rest of it.
/// @return the path to which the links lead, which need not exist; `path` itself if it is not a link
std::string link_target(const std::string& path);

/// Checks output paths before a long computation. Throws ConfigError if an output is the same file as an input or as
/// another output, under whatever name, and StorageError if an output exists and may not be replaced. Empty paths are
/// ignored.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, Existing existing);

/// Replaces or creates a file atomically: writes `bytes` to a temporary file with a random name in the same folder,
/// reads them back, syncs the file, renames it to `path` and syncs the folder. Throws StorageError with the operating
/// system's error; `path` is then unchanged and the temporary file removed. Symbolic links are followed: the link stays
/// and its target is replaced. The permissions of a replaced file are retained. Anything but a regular file (a folder,
/// a device) is never replaced.
void write_file(const std::string& path, const std::string& bytes, Existing existing);

/// Reads a regular file. Throws StorageError with the operating system's error.
/// @param max_bytes  maximum number of bytes to read, from the beginning of the file
std::string read_file(const std::string& path, std::size_t max_bytes = std::string::npos);

}  // namespace pkm
