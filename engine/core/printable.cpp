#include "engine/core/printable.hpp"

#include <algorithm>

namespace pkm {
namespace {

/// A character decoded from UTF-8.
struct Character {
  char32_t code = 0;
  std::size_t length = 0;  ///< number of bytes; 0: the bytes are not valid UTF-8
};

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// Length in bytes of the UTF-8 character with this first byte; 0: not a valid first byte.
std::size_t length_of(char first) {
  const auto byte = static_cast<unsigned char>(first);
  return byte < 0x80 ? 1 : byte < 0xC2 ? 0 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : byte < 0xF5 ? 4 : 0;
}

/// Decodes the first character of a non-empty text.
Character decode_first(std::string_view text) {
  const std::size_t length = length_of(text[0]);
  if (length <= 1) return {static_cast<unsigned char>(text[0]), length};
  if (text.size() < length || !std::all_of(text.begin() + 1, text.begin() + static_cast<long>(length), is_continuation))
    return {};
  char32_t code = static_cast<unsigned char>(text[0]) & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return overlong || surrogate || code > 0x10FFFF ? Character{} : Character{code, length};
}

/// Returns true for C0 and C1 control characters, line and paragraph separators, and bidirectional controls.
bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200E && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text, std::string_view keep) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string escaped;
  escaped.reserve(text.size());
  while (!text.empty()) {
    const Character next = decode_first(text);
    const std::size_t length = std::max<std::size_t>(1, next.length);
    const bool is_kept = length == 1 && keep.find(text[0]) != std::string_view::npos;
    if (is_kept || (next.length > 0 && !is_control(next.code))) {
      escaped += text.substr(0, length);
    } else {
      for (const char c : text.substr(0, length)) {
        const auto byte = static_cast<unsigned char>(c);
        escaped += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
      }
    }
    text.remove_prefix(length);
  }
  return escaped;
}

std::string excerpt(std::string_view text, std::size_t max_size) {
  constexpr std::string_view kEllipsis = "...";
  if (text.size() <= max_size) return std::string(text);
  std::size_t head = (max_size - kEllipsis.size()) * 3 / 4, tail = text.size() - (max_size - kEllipsis.size() - head);
  while (head > 0 && is_continuation(text[head])) --head;
  while (tail < text.size() && is_continuation(text[tail])) ++tail;
  return std::string(text.substr(0, head)) + std::string(kEllipsis) + std::string(text.substr(tail));
}

std::size_t incomplete_character_size(std::string_view text) {
  for (std::size_t back = 1; back <= std::min<std::size_t>(3, text.size()); ++back) {
    const char byte = text[text.size() - back];
    if (!is_continuation(byte)) return length_of(byte) > back ? back : 0;
  }
  return 0;
}

}  // namespace pkm
