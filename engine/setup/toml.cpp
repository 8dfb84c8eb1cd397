#include "engine/setup/toml.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

constexpr std::size_t kLongestQuote = 60;  // characters of a value that a message shows

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark counts no column
  while (!text.empty()) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

/// Byte offset of the n-th code point (0-based) of a UTF-8 line.
std::size_t byte_offset(std::string_view line, std::size_t n) {
  std::size_t byte = 0;
  for (; n > 0 && byte < line.size(); --n) {
    ++byte;
    while (byte < line.size() && (static_cast<unsigned char>(line[byte]) & 0xC0U) == 0x80U) ++byte;
  }
  return byte;
}

/// The source text of a value, shortened when long; a word when it spans lines or is the body below a [header].
std::string quote(const toml::node& node, const std::vector<std::string_view>& lines) {
  const auto& source = node.source();
  const char* word = node.is_table() ? "a table" : node.is_array() ? "an array" : "text of several lines";
  const std::size_t row = source.begin.line;
  if (source.begin.line != source.end.line || row == 0 || row > lines.size()) return word;
  const std::string_view line = lines[row - 1];
  const std::size_t first = byte_offset(line, source.begin.column - 1);
  const std::size_t last = byte_offset(line, source.end.column - 1);
  const std::string_view text = line.substr(first, last - first);
  if ((node.is_table() && !text.starts_with('{')) || (node.is_array() && text.starts_with("[["))) return word;
  const std::size_t cut = byte_offset(text, kLongestQuote);
  return std::string(text.substr(0, cut)) + (cut < text.size() ? "..." : "");
}

TomlValue convert(const toml::node& node, const std::vector<std::string_view>& lines) {
  using Kind = TomlValue::Kind;
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  value.written = quote(node, lines);
  if (const auto* table = node.as_table()) {
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, child] : *table) entries.emplace_back(&key, &child);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const auto &p = a.first->source().begin, &q = b.first->source().begin;
      return std::pair(p.line, p.column) < std::pair(q.line, q.column);
    });
    for (const auto& [key, child] : entries) {
      value.keys.emplace_back(key->str());
      value.items.push_back(convert(*child, lines));
    }
  } else if (const auto* array = node.as_array()) {
    value.kind = Kind::array;
    for (const auto& element : *array) value.items.push_back(convert(element, lines));
  } else if (const auto* text = node.as_string()) {
    value.kind = Kind::text;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Kind::integer;
    value.integer = integer->get();
    value.number = static_cast<double>(value.integer);
  } else if (const auto* number = node.as_floating_point()) {
    value.kind = Kind::number;
    value.number = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.kind = Kind::flag;
    value.flag = flag->get();
  } else {
    value.kind = Kind::time;
  }
  return value;
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

TomlValue parse_toml(const std::string& text, const std::string& file) {
  try {
    return convert(toml::parse(text), split_lines(text));
  } catch (const toml::parse_error& error) {
    throw ConfigError({file, static_cast<int>(error.source().begin.line), ""},
                      "text that is not TOML (" + std::string(error.description()) + ")", "a study in TOML");
  }
}

}  // namespace pkm
