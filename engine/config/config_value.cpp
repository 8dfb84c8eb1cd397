#include "engine/config/config_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/config/renamed_keys.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

constexpr const char* kNumbers = "a table of numbers, { name = number, ... }";

/// Text that lists the keys of a table, for messages: "a table { default = .., min = .., ... }".
std::string table_expectation(const TableSpec& spec) {
  if (!spec.header.empty()) return (spec.header.starts_with("[[") ? "tables " : "a table ") + spec.header;
  constexpr std::size_t kMost = 5;
  std::vector<std::string> words;
  for (const OptionSpec& key : spec.keys)
    if (words.size() < kMost) words.push_back(key.name + " = ..");
  if (!spec.named.empty()) words.push_back((spec.keys.empty() ? spec.noun : "name") + " = ..");
  if (spec.keys.size() > kMost) words.emplace_back("..");
  return "a table { " + join(words) + " }";
}

const char* kind_word(OptionKind kind) {
  constexpr std::array words = {"number",   "integer", "flag", "word",  "named numbers", "list of named numbers",
                                "settings", "formula", "list", "table", "alternatives"};
  return words[static_cast<std::size_t>(kind)];
}

/// Reads { name = number, ... } with the names and units of OptionSpec::fields.
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
      if (value.is_integer()) {  // an integer is accepted instead of text: limb = 2 for limb = "2"
        const std::string word = std::to_string(value.integer(-kUnbounded, kUnbounded));
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
    default:
      throw std::logic_error("an option of a catalogue entry is of the kind " + std::string(kind_word(spec.kind)));
  }
  return value.number(spec.unit, spec.lower, spec.upper);
}

}  // namespace

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
    case OptionKind::formula:
      if (spec.positive || std::isfinite(spec.lower)) break;
      return spec.unit == "1" || spec.unit == kUnitOfEntry ? "a number or a formula"
                                                           : "a number or a formula in " + spec.unit;
    case OptionKind::list:
      return spec.count > 0
                 ? "a list of " + std::to_string(spec.count) + " elements, each " + expectation(spec.parts[0])
                 : "a list, each element " + expectation(spec.parts[0]);
    case OptionKind::table:
      return table_expectation(*spec.table);
    case OptionKind::any_of: {
      std::string text;
      for (const OptionSpec& part : spec.parts) text += (text.empty() ? "" : ", or ") + expectation(part);
      return text;
    }
    case OptionKind::number:
      break;
  }
  const std::string unit = spec.unit == kUnitOfEntry ? "1" : spec.unit;
  const std::string noun = spec.kind == OptionKind::formula ? "a number or a formula" : "a number";
  if (!spec.positive) return range_text(noun, spec.lower, spec.upper, unit);
  return noun + " > " + with_unit(0, unit) +
         (std::isfinite(spec.upper) ? " and <= " + with_unit(spec.upper, unit) : "");
}

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

std::vector<OptionSpec> named_keys(const TableSpec& table, const std::vector<std::string>& names) {
  std::vector<OptionSpec> specs;
  for (const std::string& name : names) {
    specs.push_back(table.named.at(0));
    specs.back().name = name;
  }
  return specs;
}

ConfigValue::ConfigValue(const TomlValue& value, std::string file, std::string path)
    : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

ConfigValue ConfigValue::child(const TomlValue& value, std::string path, Spec spec) const {
  ConfigValue found(value, file_, std::move(path));
  found.spec_ = std::move(spec);
  return found;
}

ConfigValue::Spec ConfigValue::spec_of(const std::string& key) const {
  if (!table_) return nullptr;
  const auto& [spec, more] = *table_;
  const OptionSpec* found = spec->find(key);
  if (!found) found = find_named(more, key);
  if (!found && more.empty() && !spec->named.empty()) found = &spec->named.front();
  if (!found) throw std::logic_error(path_ + ": the key " + key + " is not in the description of the table");
  return Spec(table_, found);
}

const OptionSpec* ConfigValue::spec_as(std::initializer_list<OptionKind> kinds, std::string_view unit) const {
  if (!spec_) return nullptr;
  const auto fits = [&](const OptionSpec& spec) {
    return contains(kinds, spec.kind) && (unit.empty() || spec.unit == kUnitOfEntry || spec.unit == unit);
  };
  if (fits(*spec_)) return spec_.get();
  if (spec_->kind == OptionKind::any_of)
    if (const auto part = std::ranges::find_if(spec_->parts, fits); part != spec_->parts.end()) return &*part;
  throw std::logic_error(path_ + " is described as " + kind_word(spec_->kind) + " [" + spec_->unit + "] and read as " +
                         kind_word(*kinds.begin()) + " [" + std::string(unit) + "]");
}

const OptionSpec& ConfigValue::described_as(OptionKind kind) const {
  if (const OptionSpec* const spec = spec_as({kind})) return *spec;
  throw std::logic_error(path_ + " has no description, and is read as " + kind_word(kind));
}

double ConfigValue::number() const {
  const OptionSpec* const formula = spec_as({OptionKind::number, OptionKind::formula});
  const OptionSpec& spec = formula ? *formula : described_as(OptionKind::number);
  if (!spec.positive) return number(spec.unit, spec.lower, spec.upper);
  const double value = number(spec.unit, -kUnbounded, spec.upper);
  if (!(value > 0)) throw error(expectation(spec));
  return value;
}

std::int64_t ConfigValue::integer() const {
  const OptionSpec& spec = described_as(OptionKind::integer);
  return integer(spec.lower, spec.upper);
}

const std::string& ConfigValue::word() const { return word(described_as(OptionKind::word).choices); }

std::vector<ConfigValue> ConfigValue::elements() const { return elements(expectation(described_as(OptionKind::list))); }

double ConfigValue::number(std::string_view unit, double lower, double upper) const {
  using Kind = TomlValue::Kind;
  spec_as({OptionKind::number, OptionKind::formula}, unit);
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
  spec_as({OptionKind::flag});
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
  const OptionSpec* const spec = spec_as({OptionKind::list, OptionKind::list_of_numbers});
  std::vector<ConfigValue> list;
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    list.push_back(child(value_->items[i], path_ + "[" + std::to_string(i + 1) + "]",
                         spec && !spec->parts.empty() ? Spec(spec_, &spec->parts.front()) : nullptr));
  return list;
}

ConfigValue ConfigValue::described_by(const TableSpec& spec, const std::vector<OptionSpec>& more) const {
  expect_table(table_expectation(spec));
  std::vector<std::string> known = names_of(spec.keys, more);
  if (!spec.choice.empty()) {
    std::vector<std::string> words;
    for (const TableVariant& variant : spec.variants) words.push_back(variant.word);
    const std::string& chosen = choice(spec.choice, words);
    for (const TableVariant& variant : spec.variants)
      if (variant.word == chosen)
        for (const OptionSpec& key : variant.keys) known.push_back(key.name);
  }
  const bool any_names = !spec.named.empty() && spec.keys.empty() && more.empty();
  if (!any_names) allow(known, spec.noun);
  ConfigValue table = *this;
  table.table_ = std::make_shared<const Description>(Description{&spec, more});
  return table;
}

ConfigValue ConfigValue::table(const std::vector<OptionSpec>& more) const {
  return described_by(*described_as(OptionKind::table).table, more);
}

ConfigValue ConfigValue::table_of_names(const std::vector<std::string>& names) const {
  const TableSpec& spec = *described_as(OptionKind::table).table;
  std::string expected;
  for (const std::string& name : names) expected += (expected.empty() ? "" : ", ") + name + " = ..";
  expect_table("a table { " + expected + " }").allow(names, spec.noun);
  return described_by(spec, named_keys(spec, names));
}

std::optional<ConfigValue> ConfigValue::find_table(const std::string& key, const std::vector<OptionSpec>& more) const {
  const auto found = find(key);
  return found ? std::optional(found->table(more)) : std::nullopt;
}

std::vector<ConfigValue> ConfigValue::tables(const std::string& key, const std::vector<OptionSpec>& more) const {
  const auto list = find(key);
  if (!list) return {};
  const std::string expected = "a list of tables, each written [[" + key + "]]";
  std::vector<ConfigValue> tables;
  for (const ConfigValue& each : list->elements(expected)) tables.push_back(each.expect_table(expected).table(more));
  return tables;
}

const std::string& ConfigValue::choice(const std::string& key, const std::vector<std::string>& choices) const {
  const std::string expected = "one of " + join(choices);
  if (!has(key))
    for (const auto& present : keys())
      if (!nearest_name(present, {key}).empty())
        throw find(present)->error_of("an unknown key", key + " = " + expected, key);
  return at(key, expected).word(choices);
}

void ConfigValue::allow(const std::vector<std::string>& known, std::string_view what) const {
  for (const auto& key : keys()) {
    if (contains(known, key)) continue;
    if (const std::string present = present_name(path_.empty() ? key : path_ + "." + key); contains(known, present))
      throw find(key)->refusal("the key is now called " + present + "; 'pkmopt upgrade " + file_ + "' renames it");
    throw find(key)->error_of("an unknown " + std::string(what), "one of " + join(known), nearest_name(key, known));
  }
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
  const TomlValue* found = value_->find(key);
  if (const auto dot = key.find('.'); !found && dot != std::string::npos)
    if (const TomlValue* const within = value_->find(key.substr(0, dot))) found = within->find(key.substr(dot + 1));
  Spec spec = spec_of(key);
  if (!found) return std::nullopt;
  const std::string& name = found->key_in_file.empty() ? key : found->key_in_file;
  return child(*found, path_.empty() ? name : path_ + "." + name, std::move(spec));
}

std::optional<double> ConfigValue::find_number(const std::string& key, std::string_view unit, double lower,
                                               double upper) const {
  const auto found = find(key);
  return found ? std::optional(found->number(unit, lower, upper)) : std::nullopt;
}

ConfigValue ConfigValue::at(const std::string& key) const {
  const Spec spec = spec_of(key);
  return at(key, spec->meaning.empty() ? expectation(*spec) : expectation(*spec) + " (" + spec->meaning + ")");
}

double ConfigValue::number_at(const std::string& key) const {
  const Spec spec = spec_of(key);
  return spec->initial && !has(key) ? std::get<double>(*spec->initial) : at(key).number();
}

bool ConfigValue::flag_at(const std::string& key) const {
  const Spec spec = spec_of(key);
  return spec->initial && !has(key) ? std::get<bool>(*spec->initial) : at(key).flag();
}

std::string ConfigValue::word_at(const std::string& key) const {
  const Spec spec = spec_of(key);
  return spec->initial && !has(key) ? std::get<std::string>(*spec->initial) : at(key).word();
}

std::optional<double> ConfigValue::find_number(const std::string& key) const {
  const auto found = find(key);
  return found ? std::optional(found->number()) : std::nullopt;
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
