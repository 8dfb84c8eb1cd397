// Reads the unique names of tables of a TOML document, for the readers of studies and of mechanism files.
#pragma once

#include <string>

#include "engine/config/config_value.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {

/// The name of a table. Throws ConfigError if one of `others`, the tables of the same kind, has the same name.
/// @param expected  for messages: "a name for objectives to refer to"
template <class List>
std::string new_name(const ConfigValue& table, const std::string& kind, const List& others,
                     const std::string& expected) {
  const ConfigValue name = table.at("name", expected);
  const std::string& text = name.text(expected);
  if (text.empty()) throw name.error(expected);
  if (find_named(others, text)) throw name.refusal("there is already a " + kind + " called '" + text + "'");
  return text;
}

}  // namespace pkm
