#include "engine/config/json_schema.hpp"

#include <cmath>
#include <list>

#include <nlohmann/json.hpp>

#include "engine/config/key_specs.hpp"
#include "engine/config/mechanism_keys.hpp"
#include "engine/config/renamed_keys.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

using Json = nlohmann::ordered_json;

// Regular expression for the beginning of text with a unit, such as "200 mm".
constexpr const char* kQuantity = "^[ ]*[-+]?[0-9.]";

Json schema_of(const OptionSpec& spec);
Json schema_of(const TableSpec& table);

/// Text of a key in the schema, such as "relative accuracy of the volume" or "duration of a move [s]".
std::string description(const OptionSpec& spec) {
  const bool has_unit =
      spec.unit != "1" && spec.unit != kUnitOfEntry && spec.meaning.find('[' + spec.unit + ']') == std::string::npos;
  return spec.meaning + (has_unit ? (spec.meaning.empty() ? "[" : " [") + spec.unit + "]" : "");
}

Json json_of(const OptionValue& value) {
  return std::visit(
      []<class Value>(const Value& each) -> Json {
        if constexpr (std::is_same_v<Value, NamedSettings>) {
          Json object = Json::object();
          for (const auto& setting : each)
            object[setting.first] = std::visit([](const auto& plain) { return Json(plain); }, setting.second);
          return object;
        } else {
          return Json(each);
        }
      },
      value);
}

/// Adds the minimum and maximum of a number or an integer to its schema.
void add_bounds(const OptionSpec& spec, Json& schema) {
  const auto bound = [&spec](double value) {
    return spec.kind == OptionKind::integer ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  if (std::isfinite(spec.lower)) schema["minimum"] = bound(spec.lower);
  if (std::isfinite(spec.upper)) schema["maximum"] = bound(spec.upper);
  if (spec.positive) schema["exclusiveMinimum"] = 0;
}

/// Schema of a word that must be one of `choices`; if some of them are numbers, they may also be written as integers.
Json word_schema(const std::vector<std::string>& choices) {
  if (choices.empty()) return {{"type", "string"}};
  Json words = choices;
  for (const std::string& choice : choices)
    if (choice.find_first_not_of("0123456789") == std::string::npos) words.push_back(std::stoi(choice));
  return {{"enum", words}};
}

Json number_schema() { return {{"type", {"number", "string"}}, {"pattern", kQuantity}}; }

/// Schema of { name = number }, for the names listed in the description, otherwise for any names.
Json named_numbers_schema(const OptionSpec& spec) {
  Json schema = {{"type", "object"}};
  for (const auto& [name, unit] : spec.fields) {
    schema["properties"][name] = number_schema();
    if (unit != "1" && unit != kUnitOfEntry) schema["properties"][name]["description"] = "[" + unit + "]";
  }
  schema["additionalProperties"] = spec.fields.empty() ? number_schema() : Json(false);
  return schema;
}

Json schema_of(const OptionSpec& spec) {
  Json schema;
  switch (spec.kind) {
    case OptionKind::number:
      schema = number_schema();
      add_bounds(spec, schema);
      break;
    case OptionKind::integer:
      schema = {{"type", "integer"}};
      add_bounds(spec, schema);
      break;
    case OptionKind::flag:
      schema = {{"type", "boolean"}};
      break;
    case OptionKind::word:
      schema = word_schema(spec.field_names == FieldNames::objectives ? std::vector<std::string>() : spec.choices);
      break;
    case OptionKind::named_numbers:
      schema = named_numbers_schema(spec);
      break;
    case OptionKind::list_of_numbers:
      schema = {{"type", "array"}, {"items", named_numbers_schema(spec)}};
      break;
    case OptionKind::named_settings:
      schema = {{"type", "object"}, {"additionalProperties", {{"type", {"number", "string"}}}}};
      break;
    case OptionKind::formula:
      schema = spec.count == 3 ? Json{{"type", "string"}} : Json{{"type", {"number", "string"}}};
      add_bounds(spec, schema);
      break;
    case OptionKind::list:
      schema = {{"type", "array"}, {"items", schema_of(spec.parts.at(0))}};
      if (spec.count > 0) schema["minItems"] = schema["maxItems"] = spec.count;
      break;
    case OptionKind::table:
      schema = schema_of(*spec.table);
      break;
    case OptionKind::any_of:
      for (const OptionSpec& part : spec.parts) schema["anyOf"].push_back(schema_of(part));
      break;
  }
  if (const std::string text = description(spec); !text.empty()) schema["description"] = text;
  if (spec.initial) schema["default"] = json_of(*spec.initial);
  return schema;
}

/// Schema of a table with the given keys.
/// @param named  describes the values of all other keys; empty: there are none
Json object_schema(const std::string& meaning, const std::vector<OptionSpec>& keys,
                   const std::vector<OptionSpec>& named) {
  Json schema = {{"type", "object"}};
  if (!meaning.empty()) schema["description"] = meaning;
  Json required = Json::array();
  for (const OptionSpec& key : keys) {
    schema["properties"][key.name] = schema_of(key);
    if (key.required) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = required;
  schema["additionalProperties"] = named.empty() ? Json(false) : schema_of(named.front());
  return schema;
}

Json schema_of(const TableSpec& table) {
  if (table.variants.empty()) return object_schema(table.meaning, table.keys, table.named);
  Json schema = {{"type", "object"}, {"description", table.meaning}, {"required", {table.choice}}};
  Json others = Json::array();
  for (const TableVariant& variant : table.variants)
    if (!variant.word.empty()) others.push_back(variant.word);
  for (const TableVariant& variant : table.variants) {
    std::vector<OptionSpec> keys = table.keys;
    keys.insert(keys.end(), variant.keys.begin(), variant.keys.end());
    Json of_variant = object_schema(variant.meaning, keys, variant.named.empty() ? table.named : variant.named);
    Json& word = of_variant["properties"][table.choice];
    if (variant.word.empty())
      word = {{"type", "string"}, {"not", {{"enum", others}}}};
    else
      word = {{"const", variant.word}};
    word["description"] = variant.meaning;
    schema["oneOf"].push_back(of_variant);
  }
  return schema;
}

std::string text_of(const std::string& title, const TableSpec& root) {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  schema.update(schema_of(root));
  // Old names are invalid even where a table has keys with arbitrary names, such as coordinates.
  for (const auto& [kind, path, name] : renamed_keys())
    if (path.size() == 2 && schema.contains("properties") && schema["properties"].contains(path[0]))
      schema["properties"][path[0]]["properties"][path[1]] = {{"not", Json::object()},
                                                              {"description", "renamed to " + name}};
  return schema.dump(1) + "\n";
}

/// The tables of studies or tasks, in which the entries of the catalogues are variants.
class StudyTables {
 public:
  StudyTables(const Catalogues& catalogues, const TableSpec& root) : catalogues_(catalogues), root_(root) {
    replace("output", "type", objective_variants());
    if (!find_named(root.keys, "stage")) return;
    name_mechanisms();
    replace("objective", "type", objective_variants());
    replace("constraint", "type", constraint_variants());
    std::vector<TableVariant> optimisers;
    for (const OptimiserEntry& entry : catalogues.optimisers)
      optimisers.push_back({entry.name, entry.meaning, entry.options});
    replace("stage", "optimiser", std::move(optimisers));
  }
  const TableSpec& root() const { return root_; }

 private:
  OptionSpec& key(const std::string& name) {
    return root_.keys[static_cast<std::size_t>(find_named(root_.keys, name) - root_.keys.data())];
  }

  void name_mechanisms() {
    TableSpec& table = tables_.emplace_back(*key("mechanism").table);
    for (OptionSpec& each : table.keys)
      if (each.name == "type")
        for (const auto& mechanism : catalogues_.mechanisms) each.choices.push_back(mechanism.name());
    key("mechanism").table = &table;
  }

  void replace(const std::string& name, const std::string& choice, std::vector<TableVariant> variants) {
    TableSpec& table = tables_.emplace_back(*key(name).parts[0].table);
    if (name == "constraint") table.keys = pose_constraint_keys().keys;  // all other keys belong to the variants
    table.choice = choice;
    table.variants = std::move(variants);
    key(name).parts[0].table = &table;
  }

  std::vector<TableVariant> objective_variants() const {
    std::vector<TableVariant> variants;
    for (const ObjectiveEntry& entry : catalogues_.objectives)
      variants.push_back({entry.name, entry.meaning, entry.options});
    return variants;
  }

  /// The options that a constraint has for any of the mechanisms. If they differ between mechanisms, a mechanism file
  /// may define further options, and the schema accepts any name of an option.
  TableVariant variant_of(const ConstraintEntry& entry) const {
    TableVariant variant{entry.name, entry.meaning, {}};
    std::vector<std::string> names;
    bool any = false, differ = false;
    for (const auto& mechanism : catalogues_.mechanisms) {
      if (entry.refusal(*mechanism.get())) continue;
      const std::vector<OptionSpec> options = entry.options(mechanism.get()->info());
      differ = differ || (any && names_of(options) != names);
      names = names_of(options);
      any = true;
      for (const OptionSpec& option : options)
        if (!find_named(variant.keys, option.name)) variant.keys.push_back(option);
    }
    if (differ)
      variant.named = {{.kind = OptionKind::any_of,
                        .meaning = "a limit of a mechanism file",
                        .parts = {{.unit = kUnitOfEntry}, {.kind = OptionKind::flag}}}};
    if (!entry.pose_level()) add_keys(margin_constraint_keys(), variant);
    return variant;
  }

  /// Inserts the keys in `table` that not all constraints have into a variant, before its other keys.
  static void add_keys(const TableSpec& table, TableVariant& variant) {
    std::vector<OptionSpec> keys;
    for (const OptionSpec& key : table.keys)
      if (!find_named(pose_constraint_keys().keys, key.name)) keys.push_back(key);
    variant.keys.insert(variant.keys.begin(), keys.begin(), keys.end());
  }

  std::vector<TableVariant> constraint_variants() const {
    std::vector<TableVariant> variants;
    for (const ConstraintEntry& entry : catalogues_.constraints) variants.push_back(variant_of(entry));
    for (const ObjectiveEntry& entry : catalogues_.objectives) {
      if (find_named(catalogues_.constraints, entry.name)) continue;
      TableVariant& variant = variants.emplace_back(TableVariant{entry.name, entry.meaning, entry.options});
      add_keys(bounded_objective_keys(), variant);
    }
    TableVariant& other = variants.emplace_back(TableVariant{"", "a [[design]] of the mechanism file", {}});
    add_keys(margin_constraint_keys(), other);
    return variants;
  }

  const Catalogues& catalogues_;
  TableSpec root_;
  std::list<TableSpec> tables_;
};

}  // namespace

std::string study_schema(const Catalogues& catalogues) {
  return text_of("Study of pkmopt", StudyTables(catalogues, study_keys()).root());
}

std::string task_schema(const Catalogues& catalogues) {
  return text_of("Task file of pkmopt", StudyTables(catalogues, task_keys()).root());
}

std::string mechanism_schema() { return text_of("Mechanism file of pkmopt", mechanism_keys()); }

std::string motion_schema() { return text_of("Motion file of pkmopt", motion_file_keys()); }

std::string motor_schema() { return text_of("Motor file of pkmopt", motor_file_keys()); }

}  // namespace pkm
