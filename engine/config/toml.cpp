#include "engine/config/toml.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

constexpr std::size_t kLongestQuote = 60;  // maximum number of characters of a value that a message shows

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark does not count as a column
  while (!text.empty()) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

/// Finds columns, which toml++ counts in code points, in the bytes of the text. Values are looked up line by line, so
/// the positions of one line are cached.
class Source {
 public:
  explicit Source(std::string_view text) : lines_(split_lines(text)) {}

  /// The text between two columns (1-based, in code points) of a row (1-based); "" if there is no such row.
  std::string_view between(std::size_t row, std::size_t first, std::size_t last) {
    if (row == 0 || row > lines_.size()) return {};
    const std::string_view line = lines_[row - 1];
    if (row != row_) {
      row_ = row;
      begins_.clear();
      for (std::size_t byte = 0; byte < line.size(); ++byte)
        if (begins_character(line[byte])) begins_.push_back(byte);
    }
    const auto byte = [&](std::size_t column) { return column <= begins_.size() ? begins_[column - 1] : line.size(); };
    return line.substr(byte(first), byte(last) - byte(first));
  }

 private:
  std::vector<std::string_view> lines_;
  std::size_t row_ = 0;
  std::vector<std::size_t> begins_;
};

/// The source text of a value, abbreviated if it is long. If the value extends over several lines or is the body below
/// a [header], words such as "a table" instead.
std::string quote(const toml::node& node, Source& source) {
  const auto& [begin, end, path] = node.source();
  const char* word = node.is_table() ? "a table" : node.is_array() ? "an array" : "text of several lines";
  if (begin.line != end.line || begin.line == 0) return word;
  const std::string_view text = source.between(begin.line, begin.column, end.column);
  if (text.empty() || (node.is_table() && !text.starts_with('{')) || (node.is_array() && text.starts_with("[[")))
    return word;
  std::size_t characters = 0;
  for (std::size_t byte = 0; byte < text.size(); ++byte)
    if (begins_character(text[byte]) && ++characters > kLongestQuote) return std::string(text.substr(0, byte)) + "...";
  return std::string(text);
}

TomlValue convert(const toml::node& node, Source& source) {
  using Kind = TomlValue::Kind;
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  value.written = quote(node, source);
  if (const auto* table = node.as_table()) {
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, child] : *table) entries.emplace_back(&key, &child);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const auto &p = a.first->source().begin, &q = b.first->source().begin;
      return std::pair(p.line, p.column) < std::pair(q.line, q.column);
    });
    for (const auto& [key, child] : entries) {
      value.keys.emplace_back(key->str());
      value.items.push_back(convert(*child, source));
      value.order.push_back(value.order.size());
    }
    std::ranges::sort(value.order, {}, [&value](std::size_t i) -> const std::string& { return value.keys[i]; });
  } else if (const auto* array = node.as_array()) {
    value.kind = Kind::array;
    for (const auto& element : *array) value.items.push_back(convert(element, source));
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

/// Nesting depth of tables and arrays: number of open brackets, and number of parts of the keys in them.
struct Depth {
  std::size_t brackets = 0, parts = 0;
};

/// The line (1-based) at which tables are nested so deeply that recursive functions, such as the parser, would run out
/// of stack; 0 if there is none. No study needs this depth. The depth is determined from the text, without the parser,
/// up to the first syntax error.
int line_too_deep(std::string_view text) {
  constexpr Depth kMax{32, 16};
  Depth depth;
  int line = 1;
  // Returns the index of the last character of the string that begins at `begin`.
  const auto skip_string = [&text, &line](std::size_t begin) {
    const char quote = text[begin];
    const bool long_one = text.substr(begin).starts_with(std::string(3, quote));
    for (std::size_t i = begin + (long_one ? 3 : 1); i < text.size(); ++i) {
      if (text[i] == '\n') {
        if (!long_one) return i - 1;  // the string is not closed, so that the text is not TOML
        ++line;
      } else if (text[i] == '\\' && quote == '"') {
        i += i + 1 < text.size() && text[i + 1] != '\n';
      } else if (text[i] == quote && !long_one) {
        return i;
      } else if (long_one && text.substr(i).starts_with(std::string(3, quote))) {
        // In a multi-line string, up to two quotes that belong to the text may precede the closing quotes.
        while (i + 3 < text.size() && text[i + 3] == quote) ++i;
        return i + 2;
      }
    }
    return text.size();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = skip_string(i);
    } else if (c == '#') {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
    } else if (c == '.') {
      if (++depth.parts >= kMax.parts) return line;
    } else if (c == '[' || c == '{') {
      if (++depth.brackets > kMax.brackets) return line;
      depth.parts = 0;
    } else if (c == ']' || c == '}') {
      depth.brackets -= depth.brackets > 0;
    } else if (c == '=' || c == ',' || c == '\n') {
      depth.parts = 0;
      line += c == '\n';
    }
  }
  return 0;
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  const auto found =
      std::ranges::lower_bound(order, key, {}, [this](std::size_t i) -> const std::string& { return keys[i]; });
  return found == order.end() || keys[*found] != key ? nullptr : &items[*found];
}

void set_key(TomlValue& table, const std::string& key, TomlValue value) {
  if (const auto found = std::ranges::find(table.keys, key); found != table.keys.end()) {
    table.items[static_cast<std::size_t>(found - table.keys.begin())] = std::move(value);
    return;
  }
  table.keys.push_back(key);
  table.items.push_back(std::move(value));
  table.order.resize(table.keys.size());
  std::iota(table.order.begin(), table.order.end(), std::size_t{0});
  std::ranges::sort(table.order, {}, [&table](std::size_t i) { return table.keys[i]; });
}

TomlValue filtered(const TomlValue& table, const std::function<bool(const std::string& key)>& keep) {
  TomlValue result = table;
  result.keys.clear();
  result.items.clear();
  result.order.clear();
  for (std::size_t i = 0; i < table.keys.size(); ++i)
    if (keep(table.keys[i])) set_key(result, table.keys[i], table.items[i]);
  return result;
}

TomlValue parse_toml(const std::string& text, const std::string& file, const std::string& expected) {
  if (const int line = line_too_deep(text))
    throw ConfigError({file, line, ""}, "tables nested too deeply", "keys of at most 16 parts, in at most 32 brackets");
  try {
    Source source(text);
    return convert(toml::parse(text), source);
  } catch (const toml::parse_error& error) {
    throw ConfigError({file, static_cast<int>(error.source().begin.line), ""},
                      "text that is not TOML (" + std::string(error.description()) + ")", expected);
  }
}

}  // namespace pkm
