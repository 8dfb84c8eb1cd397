// Reading of files that users write.
#pragma once

#include <string>

namespace pkm {

/// The text of the file at `path`, at most 16 MiB (a study takes a few thousand bytes). `expected` describes
/// the contents, for messages: "a study in TOML". Throws ConfigError.
std::string read_text_file(const std::string& path, const std::string& expected);

}  // namespace pkm
