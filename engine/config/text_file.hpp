// Reading of files that users write.
#pragma once

#include <cstddef>
#include <string>

namespace pkm {

/// The text of the file at `path`. Throws ConfigError.
/// @param expected  what the contents should be, for messages: "a study in TOML"
/// @param largest   maximum size [bytes]; a study takes a few thousand
std::string read_text_file(const std::string& path, const std::string& expected,
                           std::size_t largest = std::size_t{16} << 20);

}  // namespace pkm
