// Helpers for descriptions of keys whose values are tables, formulas, points and directions.
#pragma once

#include <string>

#include "engine/core/options.hpp"

namespace pkm {

/// The description of a table, written as `name = { .. }` or [name].
inline OptionSpec table_key(const std::string& name, const TableSpec& table, const std::string& meaning = "") {
  return {
      .name = name, .kind = OptionKind::table, .meaning = meaning.empty() ? table.meaning : meaning, .table = &table};
}

/// The description of an array of tables [[name]].
inline OptionSpec tables_key(const std::string& name, const TableSpec& table) {
  return {.name = name,
          .kind = OptionKind::list,
          .meaning = table.meaning,
          .parts = {{.kind = OptionKind::table, .meaning = table.meaning, .table = &table}}};
}

/// The description of a key that must be present.
inline OptionSpec required(OptionSpec key) {
  key.required = true;
  return key;
}

inline OptionSpec formula_key(const std::string& name, const std::string& unit, const std::string& meaning) {
  return {.name = name, .kind = OptionKind::formula, .unit = unit, .meaning = meaning};
}

/// The description of a list of formulas. @param count  number of formulas; 0: any
inline OptionSpec formulas_key(const std::string& name, const std::string& unit, std::size_t count,
                               const std::string& meaning) {
  return {.name = name,
          .kind = OptionKind::list,
          .unit = unit,
          .meaning = meaning,
          .count = count,
          .parts = {{.kind = OptionKind::formula, .unit = unit}}};
}

inline OptionSpec point_key(const std::string& name, const std::string& meaning) {
  return formulas_key(name, "m", 3, meaning);
}

inline OptionSpec direction_key(const std::string& name, const std::string& meaning) {
  return formulas_key(name, "1", 3, meaning);
}

/// The description of a point: [x, y, z], or the name of a point of a limb, "arm1.C".
inline OptionSpec place_key(const std::string& name, const std::string& meaning) {
  return {.name = name,
          .kind = OptionKind::any_of,
          .unit = "m",
          .required = true,
          .meaning = meaning + ": [x, y, z] in the base's frame, or the point of a limb (\"arm1.C\")",
          .parts = {point_key("", ""), {.kind = OptionKind::word}}};
}

inline OptionSpec text_key(const std::string& name, const std::string& meaning) {
  return {.name = name, .kind = OptionKind::word, .meaning = meaning};
}

inline OptionSpec texts_key(const std::string& name, const std::string& meaning) {
  return {.name = name, .kind = OptionKind::list, .meaning = meaning, .parts = {{.kind = OptionKind::word}}};
}

}  // namespace pkm
