// Writes and reads study files (HDF5 with a checksummed header).
//
// Writing is atomic: write_study() builds the new file in memory, and write_file() replaces the previous one by a
// rename. A killed process, a full disk or a read-only folder therefore leaves the previous file intact.
//
// A header of 512 bytes precedes the HDF5 data (see file_header.hpp). It is verified before the HDF5 library reads any
// data, because HDF5 1.10 can crash on damaged input.
#pragma once

#include <string>

#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Writes the study file at `path` by write_file(). There may be only one writer at a time (see StudyLock). Throws
/// StorageError with the file name and the operating system's error; the previous file is then intact and the temporary
/// file removed. A file size limit (RLIMIT_FSIZE) is reported like a full disk, provided that the process ignores
/// SIGXFSZ.
void write_study(const std::string& path, const StudyContents& contents, Existing existing = Existing::replaced);

/// @return the bytes of the study file, header included. Throws ImageError if the contents are inconsistent.
std::string serialise_study(const StudyContents& contents);

/// Reads and verifies a study file. Throws StorageError with one sentence if the file is missing, empty, truncated,
/// damaged, not an HDF5 file, not a study, or of a newer schema. If set_check_command() has set a command, that process
/// parses the file first.
StudyContents read_study(const std::string& path);

/// Parses the bytes of a study file whose header has been verified. Throws ImageError if they do not follow the schema.
/// @param bytes   the whole file, header included
/// @param schema  schema version returned by verify_header()
StudyContents parse_study(const std::string& bytes, int schema);

}  // namespace pkm
