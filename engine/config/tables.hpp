// Tables of a TOML document: what the readers of studies and of mechanism files share.
#pragma once

#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {

/// The tables [[name]] of the document; empty if there is none. Throws ConfigError if `name` is not a list of tables.
std::vector<ConfigValue> tables_of(const ConfigValue& root, const std::string& name);

/// The value of `key` ("type", "optimiser"), which must be one of `choices`. It is read before the other keys are
/// checked, because it decides which of them are allowed. If `key` is missing, the message names a similar key.
const std::string& type_of(const ConfigValue& table, const std::string& key, const std::vector<std::string>& choices);

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
