// Lexical scanner for the keys of a TOML text and their positions, so that a key can be replaced without changing any
// other text. toml++ gives only the positions of values and of the first header of an array of tables.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pkm {

/// One part of a key as it is written: `b` of `a.b = 1`, of `[a.b]`, or of `a = { b = 1 }`.
struct TomlKey {
  /// Names of the enclosing tables, then the key's own name; arrays contribute no index.
  std::vector<std::string> path;
  std::size_t begin = 0, size = 0;  ///< bytes of the name in the text, without quotes
  int line = 0;                     ///< number of the line, from 1
};

/// All keys of a text in their order. Text that is not TOML gives meaningless keys, but no error. Escape sequences in
/// quoted keys are not decoded.
std::vector<TomlKey> find_toml_keys(std::string_view text);

}  // namespace pkm
