// Helpers for descriptions of keys whose values are tables, formulas, points and directions.
#pragma once

#include <string>
#include <utility>

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

/// The description of a number that may also be "VARIABLE.KEY", a key of the chosen row of a catalogue.
inline OptionSpec or_key_of_row(OptionSpec number) {
  OptionSpec either = number;
  either.kind = OptionKind::any_of;
  either.parts = {std::move(number), {.kind = OptionKind::word}};
  return either;
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

/// The description of a vector: three formulas [x, y, z], or a formula whose value is a vector.
inline OptionSpec vector_key(const std::string& name, const std::string& unit, const std::string& meaning) {
  return {.name = name,
          .kind = OptionKind::any_of,
          .unit = unit,
          .meaning = meaning,
          .parts = {formulas_key("", unit, 3, ""), {.kind = OptionKind::formula, .unit = unit, .count = 3}}};
}

inline OptionSpec point_key(const std::string& name, const std::string& meaning) {
  return vector_key(name, "m", meaning);
}

inline OptionSpec direction_key(const std::string& name, const std::string& meaning) {
  return vector_key(name, "1", meaning);
}

/// The description of a point in the base's frame, which may be a point of a limb.
inline OptionSpec place_key(const std::string& name, const std::string& meaning) {
  return required(point_key(
      name, meaning + ": [x, y, z] in the base's frame, or a formula such as the point \"arm1.C\" of a limb"));
}

inline OptionSpec text_key(const std::string& name, const std::string& meaning) {
  return {.name = name, .kind = OptionKind::word, .meaning = meaning};
}

inline OptionSpec texts_key(const std::string& name, const std::string& meaning) {
  return {.name = name, .kind = OptionKind::list, .meaning = meaning, .parts = {{.kind = OptionKind::word}}};
}

}  // namespace pkm
