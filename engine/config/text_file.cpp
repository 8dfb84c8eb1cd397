#include "engine/config/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/core/error.hpp"

namespace pkm {

std::string read_text_file(const std::string& path, const std::string& expected, std::size_t largest) {
  std::error_code unreadable;  // ignored, because an unreadable file is reported below, when it cannot be opened
  if (std::filesystem::is_directory(path, unreadable)) throw ConfigError({path, 0, ""}, "a folder", expected);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigError({path, 0, ""}, std::string("no readable file (") + std::strerror(errno) + ")", expected);
  std::string text;
  std::array<char, std::size_t{1} << 14> buffer;  // the buffer is small, because clearing 16 MiB takes 10 ms
  do {
    file.read(buffer.data(), buffer.size());
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest)
      throw ConfigError({path, 0, ""}, "more than " + std::to_string(largest >> 20) + " MiB", expected);
  } while (file);
  return text;
}

}  // namespace pkm
