#include "engine/storage/file_header.hpp"

#include <xxhash.h>

#include <cstdio>
#include <string_view>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

constexpr std::string_view kSignature = "pkmopt-study schema=";

std::string make_header(int schema, unsigned long long bytes, unsigned long long hash) {
  char line[128];
  std::snprintf(line, sizeof line, "%s%d bytes=%llu xxh64=%016llx\n", kSignature.data(), schema, bytes, hash);
  std::string block = line;
  block += "An HDF5 file follows at byte 512; h5py, MATLAB and the HDF5 tools open this file as it is.\n";
  block.resize(kHeaderBytes - 1, ' ');
  return block + '\n';
}

/// Hash of all bytes after the header. From schema 4 on the schema is the seed, so that a damaged schema digit is
/// detected.
unsigned long long payload_hash(const std::string& file, int schema) {
  return XXH64(file.data() + kHeaderBytes, file.size() - kHeaderBytes,
               schema < 4 ? 0 : static_cast<unsigned long long>(schema));
}

/// @return true if the file is an HDF5 file: the HDF5 signature stands at byte 0, 512, 1024, 2048, ...
bool has_hdf5_data(const std::string& file) {
  for (std::size_t at = 0; at < file.size(); at = at == 0 ? 512 : 2 * at)
    if (has_hdf5_signature(file, at)) return true;
  return false;
}

}  // namespace

std::string xxh64_hex(const std::string& text) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(XXH64(text.data(), text.size(), 0)));
  return digits;
}

bool has_hdf5_signature(const std::string& file, std::size_t at) {
  constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1a\n";
  return at <= file.size() && file.compare(at, kHdf5Signature.size(), kHdf5Signature) == 0;
}

bool has_study_header(const std::string& beginning) { return beginning.starts_with(kSignature); }

void seal(std::string& file, int schema) {
  PKM_EXPECTS(file.size() >= kHeaderBytes);
  file.replace(0, kHeaderBytes, make_header(schema, file.size() - kHeaderBytes, payload_hash(file, schema)));
}

int verify_header(const std::string& file, const std::string& path, int newest_schema) {
  if (file.empty()) throw StorageError(path + ": the file is empty");
  if (!has_study_header(file)) {
    if (std::string_view(kSignature).starts_with(file)) throw StorageError(path + ": the file is truncated");
    throw StorageError(path + (has_hdf5_data(file) ? ": an HDF5 file, but not a pkmopt study (no pkmopt header)"
                                                   : ": not a pkmopt study (neither a pkmopt header nor HDF5 data)"));
  }
  if (file.size() < kHeaderBytes) throw StorageError(path + ": the file is truncated");
  int schema = 0;
  unsigned long long bytes = 0, hash = 0;
  const std::string line = file.substr(kSignature.size(), kHeaderBytes - kSignature.size());
  const int found = std::sscanf(line.c_str(), "%d bytes=%llu xxh64=%llx", &schema, &bytes, &hash);
  // Newer versions guarantee only the position of the schema number. If the rest of the header matches the format and
  // the hash of this version, the file is not newer: its schema digit is damaged.
  if (found >= 1 && schema > newest_schema && !(found == 3 && hash == payload_hash(file, newest_schema)))
    throw StorageError(path + ": written with study schema " + std::to_string(schema) +
                       ", but this program reads schemas up to " + std::to_string(newest_schema) +
                       "; use a newer pkmopt");
  if (found != 3 || file.compare(0, kHeaderBytes, make_header(schema, bytes, hash)) != 0)
    throw StorageError(path + ": the file is damaged (its header, the first 512 bytes, is invalid)");
  const unsigned long long present = file.size() - kHeaderBytes;
  if (present < bytes)
    throw StorageError(path + ": the file is truncated (" + std::to_string(present) + " of " + std::to_string(bytes) +
                       " bytes)");
  if (present > bytes || payload_hash(file, schema) != hash)
    throw StorageError(path + ": the file is damaged or was changed by another program (its checksum differs)");
  return schema;
}

}  // namespace pkm
