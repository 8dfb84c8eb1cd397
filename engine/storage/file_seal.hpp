// The block of 512 bytes in front of a study's HDF5 data: format mark, schema, size and checksum, as text that `head`
// shows:
//
//   pkmopt-study schema=5 bytes=51200 xxh64=0123456789abcdef
//
// `bytes` and `xxh64` are size and XXH64 of all that follows the block; its seed is the schema, 0 for schemas 1 to 3.
#pragma once

#include <cstddef>
#include <string>

namespace pkm {

inline constexpr std::size_t kSealBytes = 512;

/// The XXH64 of a text, seed 0, as 16 hexadecimal digits.
std::string digest_of(const std::string& text);

/// HDF5 data begin at byte `at`.
bool starts_hdf5(const std::string& file, std::size_t at);

/// Whether a file that begins so claims to be a study.
bool is_sealed(const std::string& beginning);

/// Fills the first kSealBytes of `file`, whose remainder is complete.
void seal(std::string& file, int schema);

/// Verifies the seal of the bytes read from `path` and returns their schema. Throws StorageError with a sentence for
/// each way in which they are not a sound study of at most this schema.
int verify_seal(const std::string& file, const std::string& path, int newest_schema);

}  // namespace pkm
