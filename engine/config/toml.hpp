// A TOML document as a plain tree of values that know where they were written.
//
// The parser is toml++; nothing of it leaves toml.cpp. Unlike toml++'s tables ours keep the order of the file, because
// the order in which a study names its variables is the order in which they are stored and shown.
#pragma once

#include <cstdint>
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

  /// A table's value under `key`, or null.
  const TomlValue* find(const std::string& key) const;
};

/// Parses `text`. Throws ConfigError with the line for whatever TOML does not allow (duplicate keys, bytes that are not
/// UTF-8, ...). `file` is named in messages, `expected` says there what it should be.
TomlValue parse_toml(const std::string& text, const std::string& file, const std::string& expected = "a study in TOML");

}  // namespace pkm
