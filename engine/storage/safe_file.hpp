// Whole files, replaced so that a crash at any instant leaves the old or the new one, and nothing in between.
#pragma once

#include <string>

namespace pkm {

/// What `path` stands for: the file behind a symbolic link, which need not exist, or `path` itself. Throws StorageError
/// when links go round in circles.
std::string link_target(const std::string& path);

/// Writes `bytes` to "<path>.part", reads them back, syncs, renames over `path`, syncs the folder. Throws StorageError
/// with the system's reason; then `path` is as it was and the temporary file is gone. A symbolic link stays, and what
/// it points to is replaced; what exists and is no regular file (a folder, a device) is refused.
void replace_file(const std::string& path, const std::string& bytes);

/// Throws StorageError with the system's reason.
std::string read_file(const std::string& path);

}  // namespace pkm
