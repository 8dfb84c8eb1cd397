// Text of fixed length, padded with NUL: how a study file keeps lists of words. Private to engine/storage.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace pkm {

struct PackedText {
  std::size_t length = 1;  ///< bytes per text, at least 1
  std::string bytes;       ///< one text after the other
};

inline PackedText pack(const std::vector<std::string>& texts) {
  PackedText packed;
  for (const std::string& text : texts) packed.length = std::max(packed.length, text.size());
  packed.bytes.reserve(packed.length * texts.size());
  for (const std::string& text : texts) {
    packed.bytes += text;
    packed.bytes.append(packed.length - text.size(), '\0');
  }
  return packed;
}

inline std::vector<std::string> unpack(const std::string& bytes, std::size_t length, std::size_t count) {
  std::vector<std::string> texts(count);
  for (std::size_t i = 0; i < count; ++i) {
    texts[i] = bytes.substr(i * length, length);
    texts[i].erase(texts[i].find_last_not_of('\0') + 1);
  }
  return texts;
}

}  // namespace pkm
