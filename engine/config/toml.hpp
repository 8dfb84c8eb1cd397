// A TOML document as a tree of values with the lines where they were written.
//
// The parser is toml++, which is used in toml.cpp only. Unlike the tables of toml++, those of TomlValue keep the order
// of the file, so that variables are stored and shown in the order in which the study names them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pkm {

struct TomlValue {
  enum class Kind { flag, integer, number, text, array, table, time };

  Kind kind = Kind::table;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0;
  std::string text;
  std::vector<std::string> keys;   ///< tables: names, in the order of the file
  std::vector<std::size_t> order;  ///< tables: positions of the keys in alphabetical order, for the binary search
  std::vector<TomlValue> items;    ///< tables: one value per key; arrays: the elements
  int line = 0;                    ///< 1-based line where the value begins
  std::string written;             ///< the value as it stands in the file, for messages: "\"200 kg\"", "a table"
  /// For a value that set_key() has stored under another key than in the file: its key in the file, such as "links[2]",
  /// for messages; otherwise "".
  std::string key_in_file;

  /// A table's value under `key`, or null.
  const TomlValue* find(const std::string& key) const;
};

/// Sets the value of a key of a table.
void set_key(TomlValue& table, const std::string& key, TomlValue value);

/// A copy of a table with only those entries for which keep(key) is true.
TomlValue filtered(const TomlValue& table, const std::function<bool(const std::string& key)>& keep);

/// Parses `text`. Throws ConfigError with the line if it is not valid TOML (duplicate keys, bytes that are not UTF-8,
/// ...). `file` and `expected`, a description of the contents, are for messages.
TomlValue parse_toml(const std::string& text, const std::string& file, const std::string& expected = "a study in TOML");

}  // namespace pkm
