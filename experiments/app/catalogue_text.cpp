#include "experiments/app/catalogue.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

// Maximum number of sweeps (sets of swept coordinates) beside the default one that are listed in a table; if a
// mechanism has more, a summary is printed instead.
constexpr std::size_t kMaxListedSweeps = 8;

/// A table of a list of objects: one row per object, one column per key; empty columns are omitted.
std::vector<Row> table(const Json& list) {
  std::vector<Row> rows(list.size() + 1);
  for (const auto& [key, unused] : list.front().items()) {
    bool any = false;
    for (const auto& object : list) any = any || !object[key].is_null();
    if (!any) continue;
    rows[0].push_back(key);
    for (std::size_t i = 0; i < list.size(); ++i) rows[i + 1].push_back(cell_text(list[i][key]));
  }
  return rows;
}

/// Text such as "20 sweeps of 3 coordinates, 14 of 2 coordinates, 6 of 1 coordinate; --json lists them".
std::string sweep_summary(const Json& sweeps) {
  std::map<std::size_t, int, std::greater<>> count;
  for (const Json& sweep : sweeps) ++count[sweep["swept"].size()];
  std::vector<std::string> words;
  for (const auto& [swept, number] : count)
    words.push_back(std::to_string(number) + (words.empty() ? " sweeps of " : " of ") + std::to_string(swept) +
                    (swept == 1 ? " coordinate" : " coordinates"));
  return join(words) + "; --json lists them";
}

/// The names that expressions may use, with all statistics of a quantity joined to one entry: "lti_mean, _std, _min,
/// _max".
Json with_joined_statistics(const Json& names, const Json& quantities) {
  Json joined = Json::array();
  // Quantity to which the last entry belongs; null if the entry is not a statistic of a quantity.
  const std::string* last = nullptr;
  for (const Json& entry : names) {
    const std::string& name = entry["name"].get_ref<const std::string&>();
    const std::size_t end = name.rfind('_');
    const auto is_base = [&](const Json& quantity) { return quantity["name"] == name.substr(0, end); };
    const auto found = std::ranges::find_if(quantities, is_base);
    if (end == std::string::npos || found == quantities.end()) {
      joined.push_back(entry);
      last = nullptr;
      continue;
    }
    const std::string& quantity = (*found)["name"].get_ref<const std::string&>();
    if (last && *last == quantity) {
      joined.back()["name"].get_ref<std::string&>() += ", " + name.substr(end);
      continue;
    }
    last = &quantity;
    joined.push_back(entry);
    joined.back()["meaning"] = "statistics of " + quantity + " over the poses; undefined if no pose is feasible";
  }
  return joined;
}

/// A catalogue entry in the form in which it is printed: its single values, and its lists as tables with titles.
struct Details {
  std::vector<Row> head;  ///< names and texts of the single values
  std::vector<std::pair<std::string, std::vector<Row>>> tables;
};

Details details(const Json& entry) {
  Details found;
  const auto is_list = [](const Json& value) { return value.is_array() && !value.empty() && value[0].is_object(); };
  for (const auto& [key, value] : entry.items()) {
    if (key == "other_sweeps" && value.size() > kMaxListedSweeps) {
      found.head.push_back({key, sweep_summary(value)});
    } else if (key == "expression_names" && entry.contains("quantities")) {
      found.tables.emplace_back(key, table(with_joined_statistics(value, entry["quantities"])));
    } else if (is_list(value)) {
      found.tables.emplace_back(key, table(value));
    } else if (value.is_object()) {
      for (const auto& [inner, content] : value.items()) {
        if (is_list(content))
          found.tables.emplace_back(key + " for " + inner, table(content));
        else
          found.head.push_back({inner, content.is_array()  ? "no " + key
                                       : content.is_null() ? "no limit"
                                                           : cell_text(content)});
      }
    } else {
      found.head.push_back({key, cell_text(value)});
    }
  }
  return found;
}

/// A row of a Markdown table. Vertical bars within cells are escaped.
std::string markdown_row(const Row& row) {
  std::string line = "|";
  for (const std::string& cell : row) {
    line += ' ';
    for (const char c : cell) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + '\n';
}

std::string markdown_table(const std::vector<Row>& rows) {
  std::string text = markdown_row(rows.front()) + '|';
  for (std::size_t i = 0; i < rows.front().size(); ++i) text += "---|";
  text += '\n';
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) text += markdown_row(*row);
  return text;
}

}  // namespace

std::string cell_text(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return shortest(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::vector<std::string> words;
  for (const auto& element : value) words.push_back(cell_text(element));
  return words.empty() ? "none" : join(words, "; ");
}

std::string entry_text(const Json& entry) {
  const Details found = details(entry);
  std::string text = aligned(found.head);
  for (const auto& [title, rows] : found.tables) text += '\n' + title + '\n' + aligned(rows);
  return text;
}

std::string catalogues_markdown(const Json& catalogues) {
  std::string text =
      "# Names that a study can use\n\n"
      "All mechanisms, objectives, constraints and optimisers with their options, which are keys of their tables in a "
      "study.\nCreated by `pkmopt list --markdown > docs/reference/catalogue.md`.\n\n";
  for (const auto& [kind, entries] : catalogues.items())
    for (const auto& entry : entries) {
      const Details found = details(entry);
      text += "## " + kind + ": " + entry["name"].get<std::string>() + "\n\n";
      std::vector<Row> head = {{"", ""}};
      for (const Row& row : found.head)
        if (row[0] != "name" && row[1] != "-") head.push_back(row);
      text += markdown_table(head) + '\n';
      for (const auto& [title, rows] : found.tables) text += title + ":\n\n" + markdown_table(rows) + '\n';
    }
  text.pop_back();  // removes the last blank line
  return text;
}

}  // namespace pkm
