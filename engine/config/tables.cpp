#include "engine/config/tables.hpp"

namespace pkm {

std::vector<ConfigValue> tables_of(const ConfigValue& root, const std::string& name) {
  const auto list = root.find(name);
  if (!list) return {};
  const std::string expected = "a list of tables, each written [[" + name + "]]";
  auto tables = list->elements(expected);
  for (const auto& table : tables) table.expect_table(expected);
  return tables;
}

const std::string& type_of(const ConfigValue& table, const std::string& key, const std::vector<std::string>& choices) {
  const std::string expected = "one of " + join(choices);
  if (!table.has(key))
    for (const auto& present : table.keys())
      if (!nearest_name(present, {key}).empty())
        throw table.find(present)->error_of("an unknown key", key + " = " + expected, key);
  return table.at(key, expected).word(choices);
}

}  // namespace pkm
