// Header of a study file: 512 bytes of text in front of the HDF5 data with signature, schema version, size and
// checksum, readable with `head`:
//
//   pkmopt-study schema=5 bytes=51200 xxh64=0123456789abcdef
//
// `bytes` and `xxh64` are the size and the XXH64 hash of all bytes after the header. The seed of the hash is the schema
// version (0 for schemas 1 to 3). For HDF5 the header is a user block, which every HDF5 reader skips.
#pragma once

#include <cstddef>
#include <string>

namespace pkm {

inline constexpr std::size_t kHeaderBytes = 512;  ///< size of the header

/// @return the XXH64 hash (seed 0) of a text, as 16 hexadecimal digits
std::string xxh64_hex(const std::string& text);

/// @return true if the HDF5 signature stands at byte `at`
bool has_hdf5_signature(const std::string& file, std::size_t at);

/// @return true if a file that begins with these bytes has the signature of a study file
bool has_study_header(const std::string& beginning);

/// Writes the header into the first kHeaderBytes bytes of `file`. The other bytes must not change afterwards.
void seal(std::string& file, int schema);

/// Verifies signature, schema, size and checksum. Throws StorageError with a specific sentence for each way in which
/// the file is invalid.
/// @param file  all bytes of the file
/// @param path  path of the file, for messages
/// @param newest_schema  highest schema version that is accepted
/// @return the schema version of the file
int verify_header(const std::string& file, const std::string& path, int newest_schema);

}  // namespace pkm
