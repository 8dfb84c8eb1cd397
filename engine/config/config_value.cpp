#include "engine/config/config_value.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

constexpr const char* kNumbers = "a table of numbers, { name = number, ... }";

std::string expectation(const OptionSpec& spec) {
  switch (spec.kind) {
    case OptionKind::integer:
      return range_text("an integer", spec.lower, spec.upper);
    case OptionKind::flag:
      return "true or false";
    case OptionKind::word:
      return spec.choices.empty() ? "text" : "one of " + join(spec.choices);
    case OptionKind::named_numbers:
      return kNumbers;
    case OptionKind::list_of_numbers:
      return "a list of tables, [{ name = number, ... }, ...]";
    case OptionKind::named_settings:
      return "a table, { name = number or text, ... }";
    case OptionKind::number:
      break;
  }
  return range_text("a number", spec.lower, spec.upper, spec.unit);
}

/// { name = number, ... } with the names and units of `fields`.
NamedNumbers read_fields(const ConfigValue& table, const OptionSpec& spec) {
  std::vector<std::string> names;
  for (const auto& field : spec.fields) names.push_back(field.first);
  table.expect_table(kNumbers).allow(names, "name");
  NamedNumbers numbers;
  for (const auto& [name, unit] : spec.fields) {
    if (spec.field_names == FieldNames::objectives) table.at(name, "a value for every objective: " + join(names));
    if (const auto number = table.find_number(name, unit)) numbers[name] = *number;
  }
  return numbers;
}

OptionValue read_option(const ConfigValue& value, const OptionSpec& spec) {
  switch (spec.kind) {
    case OptionKind::integer:
      return value.integer(spec.lower, spec.upper);
    case OptionKind::flag:
      return value.flag();
    case OptionKind::word:
      if (spec.choices.empty()) return value.text(expectation(spec));
      if (value.is_integer()) {  // "limb = 2" is as good as limb = "2"
        const std::string word = std::to_string(value.integer());
        if (contains(spec.choices, word)) return word;
      }
      return value.word(spec.choices);
    case OptionKind::named_numbers: {
      if (!spec.fields.empty()) return read_fields(value, spec);
      NamedNumbers numbers;
      for (const auto& key : value.expect_table(kNumbers).keys())
        numbers[key] = value.find(key)->number(spec.unit, spec.lower, spec.upper);
      return numbers;
    }
    case OptionKind::list_of_numbers: {
      std::vector<NamedNumbers> list;
      for (const auto& table : value.elements(expectation(spec))) list.push_back(read_fields(table, spec));
      return list;
    }
    case OptionKind::named_settings: {
      NamedSettings settings;
      for (const auto& key : value.expect_table(expectation(spec)).keys()) settings[key] = value.find(key)->setting();
      return settings;
    }
    case OptionKind::number:
      break;
  }
  return value.number(spec.unit, spec.lower, spec.upper);
}

}  // namespace

std::string range_text(std::string_view noun, double lower, double upper, std::string_view unit) {
  const bool below = std::isfinite(upper), above = std::isfinite(lower);
  const std::string head{noun};
  if (above && below)
    return head + " in [" + shortest(lower) + ", " + shortest(upper) + "]" +
           (unit == "1" ? "" : " " + std::string(unit));
  if (above) return head + " >= " + with_unit(lower, unit);
  if (below) return head + " <= " + with_unit(upper, unit);
  return unit == "1" ? head : head + " in " + std::string(unit);
}

ConfigValue::ConfigValue(const TomlValue& value, std::string file, std::string path)
    : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

double ConfigValue::number(std::string_view unit, double lower, double upper) const {
  using Kind = TomlValue::Kind;
  std::optional<double> result;
  if (is_text()) result = parse_quantity(value_->text, unit);
  if (value_->kind == Kind::number || value_->kind == Kind::integer) result = value_->number;
  if (!result || !std::isfinite(*result)) throw error(quantity_hint(unit));
  if (!(*result >= lower && *result <= upper)) throw error(range_text("a number", lower, upper, unit));
  if (const std::string hint = angle_hint(*result, unit); !hint.empty()) throw error(hint);
  return *result;
}

double ConfigValue::positive(std::string_view unit) const {
  const double value = number(unit);
  if (!(value > 0)) throw error("a number > " + with_unit(0, unit));
  return value;
}

std::int64_t ConfigValue::integer(double lower, double upper) const {
  const auto number = static_cast<double>(value_->integer);
  if (value_->kind != TomlValue::Kind::integer || number < lower || number > upper)
    throw error(range_text("an integer", lower, upper));
  return value_->integer;
}

bool ConfigValue::flag() const {
  if (value_->kind != TomlValue::Kind::flag) throw error("true or false");
  return value_->flag;
}

Setting ConfigValue::setting() const {
  using Kind = TomlValue::Kind;
  if (value_->kind == Kind::integer) return value_->integer;
  if (value_->kind == Kind::number && std::isfinite(value_->number)) return value_->number;
  return text("a finite number, an integer or text");
}

const std::string& ConfigValue::text(std::string_view expected) const {
  if (!is_text()) throw error(expected);
  return value_->text;
}

const std::string& ConfigValue::word(const std::vector<std::string>& choices) const {
  const std::string expected = "one of " + join(choices);
  const std::string& found = text(expected);
  if (!contains(choices, found)) throw error(expected, nearest_name(found, choices));
  return found;
}

std::vector<ConfigValue> ConfigValue::elements(std::string_view expected) const {
  if (value_->kind != TomlValue::Kind::array) throw error(expected);
  std::vector<ConfigValue> list;
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    list.emplace_back(value_->items[i], file_, path_ + "[" + std::to_string(i + 1) + "]");
  return list;
}

void ConfigValue::allow(const std::vector<std::string>& known, std::string_view what) const {
  for (const auto& key : keys())
    if (!contains(known, key))
      throw find(key)->error_of("an unknown " + std::string(what), "one of " + join(known), nearest_name(key, known));
}

std::vector<std::string> ConfigValue::dotted_keys(bool of_tables) const {
  const auto is_table = [](const TomlValue& value) { return value.kind == TomlValue::Kind::table; };
  std::vector<std::string> all;
  for (const std::string& key : keys()) {
    const TomlValue& value = *value_->find(key);
    const bool plain = key.find('.') == std::string::npos;
    if (plain && is_table(value) && !value.keys.empty() && (!of_tables || std::ranges::all_of(value.items, is_table)))
      for (const std::string& inner : value.keys) all.push_back(key + "." + inner);
    else
      all.push_back(key);
  }
  return all;
}

std::optional<ConfigValue> ConfigValue::find(const std::string& key) const {
  const TomlValue* child = value_->find(key);
  if (const auto dot = key.find('.'); !child && dot != std::string::npos)
    if (const TomlValue* const within = value_->find(key.substr(0, dot))) child = within->find(key.substr(dot + 1));
  if (!child) return std::nullopt;
  return ConfigValue(*child, file_, path_.empty() ? key : path_ + "." + key);
}

std::optional<double> ConfigValue::find_number(const std::string& key, std::string_view unit, double lower,
                                               double upper) const {
  const auto found = find(key);
  return found ? std::optional(found->number(unit, lower, upper)) : std::nullopt;
}

ConfigValue ConfigValue::at(const std::string& key, std::string_view expected) const {
  if (auto found = find(key)) return *found;
  SourceLocation missing = place();
  missing.key += (path_.empty() ? "" : ".") + key;
  throw ConfigError(missing, "nothing", expected);
}

const ConfigValue& ConfigValue::expect_table(std::string_view expected) const {
  if (!is_table()) throw error(expected);
  return *this;
}

ConfigError ConfigValue::error(std::string_view expected, std::string_view nearest) const {
  return ConfigError(place(), value_->written, expected, nearest);
}

ConfigError ConfigValue::error_of(std::string_view found, std::string_view expected, std::string_view nearest) const {
  return ConfigError(place(), found, expected, nearest);
}

ConfigError ConfigValue::refusal(std::string_view sentence) const { return ConfigError(place(), sentence); }

Options read_options(const ConfigValue& table, const std::vector<OptionSpec>& specs) {
  Options options = default_options(specs);
  for (const auto& spec : specs) {
    if (const auto value = table.find(spec.name))
      options.set(spec.name, read_option(*value, spec));
    else if (spec.required)
      table.at(spec.name, expectation(spec));
  }
  return options;
}

}  // namespace pkm
