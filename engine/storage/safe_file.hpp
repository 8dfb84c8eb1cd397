// Whole files, replaced so that a crash at any instant leaves the old or the new one, and nothing in between.
#pragma once

#include <string>

namespace pkm {

/// Writes `bytes` to "<path>.part", reads them back, syncs, renames over `path`, syncs the folder. Throws StorageError
/// with the system's reason; then `path` is as it was and the temporary file is gone.
void replace_file(const std::string& path, const std::string& bytes);

/// Throws StorageError with the system's reason.
std::string read_file(const std::string& path);

}  // namespace pkm
