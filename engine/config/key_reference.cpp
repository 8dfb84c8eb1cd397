#include "engine/config/key_reference.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "engine/config/config_value.hpp"
#include "engine/config/mechanism_keys.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

/// Escapes vertical bars within a cell of a table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

/// The table that is the value of a key, if its keys are listed below the key; otherwise null.
const TableSpec* inline_table(const OptionSpec& key) {
  if (key.kind == OptionKind::table) return key.table;
  if (key.kind == OptionKind::list || key.kind == OptionKind::any_of)
    for (const OptionSpec& part : key.parts)
      if (const TableSpec* const table = inline_table(part)) return table;
  return nullptr;
}

/// Text in the reference that states which values a key accepts; tables are given by their names only.
std::string value_text(const OptionSpec& key) {
  switch (key.kind) {
    case OptionKind::table:
      return key.table->keys.empty() ? "table by " + key.table->noun : "table";
    case OptionKind::list: {
      const std::string count = key.count > 0 ? " of " + std::to_string(key.count) : "";
      return "list" + count + ": " + value_text(key.parts.front());
    }
    case OptionKind::any_of: {
      std::string text;
      for (const OptionSpec& part : key.parts) text += (text.empty() ? "" : ", or ") + value_text(part);
      return text;
    }
    default:
      return expectation(key);
  }
}

void add_rows(const std::vector<OptionSpec>& keys, const std::string& prefix, std::string& rows);

/// Appends the row of a key to `rows`, and those of the keys in its inline table.
/// @param shown  the key as written in the row, with the names of enclosing tables
void add_row(const OptionSpec& key, const std::string& shown, std::string& rows) {
  const std::string initial = key.required ? "required" : key.initial ? '`' + to_text(*key.initial) + '`' : "";
  rows += "| `" + shown + "` | " + cell(value_text(key)) + " | " + initial + " | " + cell(key.meaning) + " |\n";
  const TableSpec* const table = inline_table(key);
  if (!table) return;
  const std::string prefix = shown + (key.kind == OptionKind::list ? "[]." : ".");
  add_rows(table->keys, prefix, rows);
  for (const OptionSpec& named : table->named)
    if (table->noun != "parameter" || !inline_table(named)) add_row(named, prefix + "NAME", rows);
}

void add_rows(const std::vector<OptionSpec>& keys, const std::string& prefix, std::string& rows) {
  for (const OptionSpec& key : keys) add_row(key, prefix + key.name, rows);
}

std::string markdown_table(const std::string& rows) {
  return rows.empty() ? "" : "| key | value | default | meaning |\n|---|---|---|---|\n" + rows + "\n";
}

std::string sentence(const std::string& text) {
  return static_cast<char>(std::toupper(text[0])) + text.substr(1) + ".\n\n";
}

/// Adds the keys of all variants of a table; keys that several variants have in common are listed once.
void add_variants(const TableSpec& table, std::string& text) {
  std::vector<std::pair<std::vector<std::string>, std::string>>
      groups;  // for each group of variants, their words and the rows of their keys
  const auto add = [&groups](const std::vector<std::string>& words) -> std::string& {
    for (auto& [known, rows] : groups)
      if (known == words) return rows;
    return groups.emplace_back(words, "").second;
  };
  std::vector<std::string> seen;
  for (const TableVariant& variant : table.variants)
    for (const OptionSpec& key : variant.keys) {
      std::string rows;
      add_row(key, key.name, rows);
      if (std::ranges::find(seen, rows) != seen.end()) continue;
      seen.push_back(rows);
      std::vector<std::string> words;
      for (const TableVariant& other : table.variants)
        for (const OptionSpec& same : other.keys) {
          std::string others;
          add_row(same, same.name, others);
          if (others == rows) words.push_back('"' + other.word + '"');
        }
      add(words) += rows;
    }
  for (const TableVariant& variant : table.variants)
    text += "- `" + table.choice + " = \"" + variant.word + "\"`: " + variant.meaning + "\n";
  if (!table.variants.empty()) text += '\n';
  for (const auto& [words, rows] : groups)
    text += "With `" + table.choice + " = " + join(words, "` or `") + "`:\n\n" + markdown_table(rows);
}

void add_table(const TableSpec& table, std::string& text) {
  if (!table.header.empty()) text += "### " + table.header + "\n\n";
  text += sentence(table.meaning);
  std::string rows;
  add_rows(table.keys, "", rows);
  for (const OptionSpec& named : table.named) add_row(named, "NAME", rows);
  text += markdown_table(rows);
  add_variants(table, text);
}

void add_file(const std::string& title, const std::string& kind, const TableSpec& root, std::string& text) {
  text += "## " + title + "\n\nJSON Schema: `pkmopt schema" + (kind.empty() ? "" : " " + kind) + "`.\n\n";
  for (const OptionSpec& key : root.keys) add_table(*inline_table(key), text);
}

}  // namespace

std::string keys_markdown() {
  std::string text =
      "# Keys\n\nAll keys of the TOML files that pkmopt reads. Created by `pkmopt schema --markdown > "
      "docs/reference/keys.md`.\n\nA number is in SI units, or text with a unit (`\"200 mm\"`). A formula is a number, "
      "text "
      "with a unit, or a formula of names. `NAME` stands for names of coordinates, parameters and so on; `[]` for "
      "every "
      "element of a list. The options of objectives, constraints and optimisers are in the catalogue "
      "([catalogue.md](catalogue.md)).\n\n";
  add_file("Studies", "", study_keys(), text);
  add_file("Mechanism files", "mechanism", mechanism_keys(), text);
  text +=
      "## Motion files\n\nJSON Schema: `pkmopt schema motion`. The keys are those of `[[motion]]` in a study, without "
      "`name` and `follow`.\n\n";
  text +=
      "## Task files\n\nJSON Schema: `pkmopt schema task`. `[[region]]`, `[[motion]]`, `[[output]]`, `[[motor]]` and "
      "the "
      "limits of `[workspace]` have the keys that they have in a study. So has `[[drive_train]]`, but its `joint` is a "
      "kind of joints: \"all\", \"revolute\" or \"prismatic\".\n\n";
  for (const char* const name : {"task", "origin"}) add_table(*inline_table(*find_named(task_keys().keys, name)), text);
  add_file("Motor files", "motors", motor_file_keys(), text);
  text.pop_back();  // remove the last blank line
  return text;
}

}  // namespace pkm
