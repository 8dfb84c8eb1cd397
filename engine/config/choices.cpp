#include "engine/config/choices.hpp"

#include <algorithm>

#include "engine/config/motor_table.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

/// The rows of a catalogue as [[motor]] tables: copies without the keys that motors do not have.
std::vector<TomlValue> motors_of(const Catalogue& catalogue) {
  std::vector<TomlValue> motors;
  for (const TomlValue& row : catalogue.rows) {
    TomlValue& motor = motors.emplace_back(TomlValue{.line = row.line, .written = row.written});
    for (std::size_t k = 0; k < row.keys.size(); ++k)
      if (find_named(motor_keys().keys, row.keys[k])) set_key(motor, row.keys[k], row.items[k]);
  }
  return motors;
}

/// Adds motors to those of a study or a motor file.
void add_motors(TomlValue& document, const std::vector<TomlValue>& added) {
  TomlValue motors = document.find("motor") ? *document.find("motor") : TomlValue{.kind = TomlValue::Kind::array};
  motors.items.insert(motors.items.end(), added.begin(), added.end());
  set_key(document, "motor", std::move(motors));
}

/// Reads a catalogue for the variable `variable` from the text of the catalogue's file.
Catalogue read_catalogue(const std::string& variable, SourceText file) {
  const TomlValue document = parse_toml(file.text, file.file_name, "a catalogue in TOML");
  const std::string expected = "a catalogue: one list of tables, for example [[motor]], each with a name";
  if (document.keys.size() != 1 || document.items[0].kind != TomlValue::Kind::array)
    throw ConfigError({file.file_name, 0, ""},
                      document.keys.size() == 1 ? "no list of tables" : std::to_string(document.keys.size()) + " keys",
                      expected);
  Catalogue found{variable, std::move(file), document.keys[0], document.items[0].items, {}};
  const std::string& name_of_file = found.file.file_name;
  if (found.rows.size() < 2)
    throw ConfigError({name_of_file, document.items[0].line, found.list}, std::to_string(found.rows.size()) + " rows",
                      "at least two");
  for (std::size_t k = 0; k < found.rows.size(); ++k) {
    const ConfigValue row(found.rows[k], name_of_file, found.list + "[" + std::to_string(k + 1) + "]");
    const ConfigValue name = row.expect_table().at("name", "the name of the row");
    if (contains(found.names, name.text("text"))) throw name.refusal("another row has this name");
    found.names.push_back(name.text("text"));
  }
  if (found.list == "motor") {  // errors in these motors are reported with the lines of this file
    TomlValue motors;
    add_motors(motors, motors_of(found));
    read_motors(ConfigValue(motors, name_of_file, "").described_by(motor_file_keys()));
  }
  return found;
}

/// The catalogue that a text such as "motor.gear" (VARIABLE.KEY) refers to; null if the text does not begin with the
/// name of a variable that is a choice from a catalogue, and a dot.
const Catalogue* catalogue_of(const std::string& text, const std::vector<Catalogue>& catalogues) {
  const auto dot = text.find('.');
  if (dot == std::string::npos) return nullptr;
  const auto found = std::ranges::find(catalogues, text.substr(0, dot), &Catalogue::variable);
  return found == catalogues.end() ? nullptr : &*found;
}

/// Replaces all texts "VARIABLE.KEY" in a value, and in the values nested in it, by the values of KEY in the chosen
/// rows.
void replace_keys(TomlValue& value, const SourceLocation& place, const std::vector<Catalogue>& catalogues,
                  const std::vector<std::size_t>& rows) {
  for (std::size_t k = 0; k < value.items.size(); ++k) {
    const std::string key = value.kind == TomlValue::Kind::table ? value.keys[k] : std::to_string(k + 1);
    replace_keys(value.items[k], {place.file, value.items[k].line, place.key + "." + key}, catalogues, rows);
  }
  if (value.kind != TomlValue::Kind::text) return;
  const Catalogue* const from = catalogue_of(value.text, catalogues);
  if (!from) return;
  const TomlValue& row = from->rows[rows[static_cast<std::size_t>(from - catalogues.data())]];
  const std::string key = value.text.substr(value.text.find('.') + 1);
  const TomlValue* const found = row.find(key);
  if (!found)
    throw ConfigError(place,
                      "'" + value.text + "', but the row '" + row.find("name")->text + "' of " + from->file.file_name +
                          " has no such key",
                      "one of " + join(row.keys), nearest_name(key, row.keys));
  const int line = value.line;
  value = *found;
  value.line = line;
}

/// Replaces a value that is the name of a row of a catalogue by the number of this row, from 1.
void replace_name(TomlValue& value, const SourceLocation& place, const Catalogue& of) {
  const std::string expected = "one of " + join(of.names);
  if (value.kind != TomlValue::Kind::text) throw ConfigValue(value, place.file, place.key).error(expected);
  const auto found = std::ranges::find(of.names, value.text);
  if (found == of.names.end())
    throw ConfigValue(value, place.file, place.key).error(expected, nearest_name(value.text, of.names));
  value.kind = TomlValue::Kind::integer;
  value.integer = found - of.names.begin() + 1;
  value.number = static_cast<double>(value.integer);
}

/// The value of a key of `table`, for modification; null if the table has no such key.
TomlValue* find_table(TomlValue& table, const std::string& key) {
  const auto found = std::ranges::find(table.keys, key);
  return found == table.keys.end() ? nullptr : &table.items[static_cast<std::size_t>(found - table.keys.begin())];
}

}  // namespace

std::vector<Catalogue> read_catalogues(const TomlValue& study, const std::string& file_name,
                                       const std::function<SourceText(const ConfigValue&)>& find) {
  std::vector<Catalogue> found;
  const TomlValue* const variables = study.find("variables");
  for (std::size_t k = 0; variables && k < variables->items.size(); ++k) {
    const ConfigValue variable(variables->items[k], file_name, "variables." + variables->keys[k]);
    if (!variable.is_table() || !variable.has("from")) continue;
    variable.allow({"from"});
    found.push_back(read_catalogue(variables->keys[k], find(*variable.find("from"))));
  }
  return found;
}

std::vector<std::size_t> rows_of_baseline(const TomlValue& study, const std::string& file_name,
                                          const std::vector<Catalogue>& catalogues) {
  std::vector<std::size_t> rows;
  const TomlValue* const baseline = study.find("baseline");
  for (const Catalogue& catalogue : catalogues) {
    const TomlValue* const given = baseline ? baseline->find(catalogue.variable) : nullptr;
    TomlValue number = given ? *given : TomlValue{.kind = TomlValue::Kind::text, .text = catalogue.names[0]};
    replace_name(number, {file_name, number.line, "baseline." + catalogue.variable}, catalogue);
    rows.push_back(static_cast<std::size_t>(number.integer) - 1);
  }
  return rows;
}

std::vector<std::string> parameters_of_rows(const TomlValue& study, const std::vector<Catalogue>& catalogues) {
  std::vector<std::string> names;
  const TomlValue* const mechanism = study.find("mechanism");
  const TomlValue* const parameters = mechanism ? mechanism->find("parameters") : nullptr;
  for (std::size_t k = 0; parameters && k < parameters->items.size(); ++k)
    if (catalogue_of(parameters->items[k].text, catalogues)) names.push_back(parameters->keys[k]);
  return names;
}

TomlValue with_rows(const TomlValue& study, const std::string& file_name, const std::vector<Catalogue>& catalogues,
                    const std::vector<std::size_t>& rows) {
  TomlValue result = study;
  for (const char* const key : {"drive_train", "mechanism"})
    if (TomlValue* const table = find_table(result, key))
      replace_keys(*table, {file_name, table->line, key}, catalogues, rows);
  for (std::size_t k = 0; k < catalogues.size(); ++k) {
    const Catalogue& catalogue = catalogues[k];
    if (catalogue.list == "motor") add_motors(result, motors_of(catalogue));
    const std::string last = std::to_string(catalogue.names.size());
    TomlValue parameters = result.find("parameters") ? *result.find("parameters") : TomlValue();
    if (const TomlValue* const other = parameters.find(catalogue.variable))
      throw ConfigValue(*other, file_name, "parameters." + catalogue.variable)
          .refusal("the variable of this name is a choice from " + catalogue.file.file_name);
    set_key(parameters, catalogue.variable,
            parse_toml("default = " + std::to_string(rows[k] + 1) + "\nmin = 1\nmax = " + last +
                           "\nmeaning = \"choice from a catalogue\"\n",
                       file_name));
    set_key(result, "parameters", std::move(parameters));
    set_key(*find_table(result, "variables"), catalogue.variable,
            parse_toml("min = 1\nmax = " + last + "\nstep = 1\n", file_name));
    if (TomlValue* const baseline = find_table(result, "baseline"))
      if (TomlValue* const value = find_table(*baseline, catalogue.variable))
        replace_name(*value, {file_name, value->line, "baseline." + catalogue.variable}, catalogue);
    if (TomlValue* const references = find_table(result, "reference"))
      for (TomlValue& reference : references->items)
        if (TomlValue* const design = find_table(reference, "design"))
          if (TomlValue* const value = find_table(*design, catalogue.variable))
            replace_name(*value, {file_name, value->line, "reference.design." + catalogue.variable}, catalogue);
  }
  return result;
}

}  // namespace pkm
