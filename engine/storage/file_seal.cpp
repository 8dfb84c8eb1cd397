#include "engine/storage/file_seal.hpp"

#include <xxhash.h>

#include <cstdio>
#include <string_view>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

constexpr std::string_view kMark = "pkmopt-study schema=";

std::string make_seal(int schema, unsigned long long bytes, unsigned long long hash) {
  char line[128];
  std::snprintf(line, sizeof line, "%s%d bytes=%llu xxh64=%016llx\n", kMark.data(), schema, bytes, hash);
  std::string block = line;
  block += "An HDF5 file follows at byte 512; h5py, MATLAB and the HDF5 tools open this file as it is.\n";
  block.resize(kSealBytes - 1, ' ');
  return block + '\n';
}

/// From schema 4 on the schema is part of what is summed up: another digit does not match.
unsigned long long hash_of(const std::string& file, int schema) {
  return XXH64(file.data() + kSealBytes, file.size() - kSealBytes,
               schema < 4 ? 0 : static_cast<unsigned long long>(schema));
}

/// They may begin at byte 0, 512, 1024, 2048, ...
bool has_hdf5_data(const std::string& file) {
  for (std::size_t at = 0; at < file.size(); at = at == 0 ? 512 : 2 * at)
    if (starts_hdf5(file, at)) return true;
  return false;
}

}  // namespace

std::string digest_of(const std::string& text) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(XXH64(text.data(), text.size(), 0)));
  return digits;
}

bool starts_hdf5(const std::string& file, std::size_t at) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  return at <= file.size() && file.compare(at, signature.size(), signature) == 0;
}

bool is_sealed(const std::string& beginning) { return beginning.starts_with(kMark); }

void seal(std::string& file, int schema) {
  PKM_EXPECTS(file.size() >= kSealBytes);
  file.replace(0, kSealBytes, make_seal(schema, file.size() - kSealBytes, hash_of(file, schema)));
}

int verify_seal(const std::string& file, const std::string& path, int newest_schema) {
  if (file.empty()) throw StorageError(path + ": the file is empty");
  if (!is_sealed(file)) {
    if (std::string_view(kMark).starts_with(file)) throw StorageError(path + ": the file is truncated");
    throw StorageError(path + (has_hdf5_data(file) ? ": an HDF5 file, but not a pkmopt study (no pkmopt mark)"
                                                   : ": not a pkmopt study (neither pkmopt mark nor HDF5 data)"));
  }
  if (file.size() < kSealBytes) throw StorageError(path + ": the file is truncated");
  int schema = 0;
  unsigned long long bytes = 0, hash = 0;
  const std::string line = file.substr(kMark.size(), kSealBytes - kMark.size());
  const int found = std::sscanf(line.c_str(), "%d bytes=%llu xxh64=%llx", &schema, &bytes, &hash);
  // Only the first number is promised to newer versions. Where all is as this version writes it, the digit is damaged.
  if (found >= 1 && schema > newest_schema && !(found == 3 && hash == hash_of(file, newest_schema)))
    throw StorageError(path + ": written with study schema " + std::to_string(schema) +
                       ", but this program reads schemas up to " + std::to_string(newest_schema) +
                       "; use a newer pkmopt");
  if (found != 3 || file.compare(0, kSealBytes, make_seal(schema, bytes, hash)) != 0)
    throw StorageError(path + ": the file is damaged (its first 512 bytes are not as written)");
  const unsigned long long present = file.size() - kSealBytes;
  if (present < bytes)
    throw StorageError(path + ": the file is truncated (" + std::to_string(present) + " of " + std::to_string(bytes) +
                       " bytes)");
  if (present > bytes || hash_of(file, schema) != hash)
    throw StorageError(path + ": the file is damaged or was changed by another program (its checksum differs)");
  return schema;
}

}  // namespace pkm
