// Writing and reading study files.
//
// What carries the study's name is always a complete file: write_study builds the new contents in memory, and
// write_file gives them the name. So a killed process, a full disk or a read-only folder leaves the previous file as it
// was.
//
// The HDF5 data follow a block of 512 bytes (an HDF5 user block, which every HDF5 reader skips) that holds format mark,
// schema, size and checksum as text. A file is verified against it before HDF5 sees a byte: HDF5 1.10 can crash on
// damaged input.
#pragma once

#include <string>

#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Writes the study file at `path`, as write_file does. One writer at a time (see StudyLock). Throws StorageError with
/// the file's name and the system's reason; the previous file is then intact and the temporary one removed. A size
/// limit (RLIMIT_FSIZE) is reported like a full disk provided that the process ignores SIGXFSZ.
void write_study(const std::string& path, const StudyContents& contents, Existing existing = Existing::replaced);

/// The bytes that write_study() writes. Throws ImageError where the contents contradict themselves.
std::string pack_study(const StudyContents& contents);

/// Reads and verifies a study file, without changing it. Throws StorageError with one sentence for a file that is
/// missing, empty, truncated, damaged, no HDF5 file, another program's, or of a newer schema.
/// Where use_file_checker() named a helper, it parses the file first.
StudyContents read_study(const std::string& path);

/// The contents of a file's bytes, whose seal says `schema`. Throws ImageError where they are not laid out so.
StudyContents parse_study(const std::string& bytes, int schema);

}  // namespace pkm
