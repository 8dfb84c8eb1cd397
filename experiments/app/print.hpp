// Output of results as text and as JSON: formatted numbers, aligned tables.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/formatted.hpp"
#include "engine/core/options.hpp"
#include "engine/core/text_table.hpp"

namespace pkm {

/// JSON with keys in the order of insertion; numbers that are not finite are printed as null.
using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

/// Text of a number with its unit and 12 significant digits; "not computed" for NaN.
std::string number(double value, std::string_view unit = "1");
/// Text of the value of a coordinate or a joint; an angle is also given in degrees: "0.349065850399 rad (20 deg)".
std::string position(double value, std::string_view unit);

/// Unit in which derivatives with respect to a quantity are printed: mm for m, deg for rad, otherwise the SI unit
/// itself.
struct DisplayUnit {
  double size;  ///< value of the unit in SI
  std::string name;
};
DisplayUnit display_unit(const std::string& si_unit);

/// Text of a number with ten significant digits; "-" for NaN.
inline std::string digits(double value) { return formatted("%.10g", value); }

void print_json(const Json& json);

/// Collects the output of a command, which is printed as text for people or as one JSON object for programs.
struct Printout {
  bool as_json = false;
  std::vector<Row> head = {};  ///< first lines of the text, as pairs of a name and a value
  std::string text = {};       ///< text that is printed below `head`
  Json json = Json::object();
  /// JSON objects that are printed instead of `json`, one per line, if there are any.
  std::vector<Json> json_lines = {};

  /// Adds a value to the JSON object and its text to the head.
  void add(const std::string& name, const std::string& word) { add(name, word, word); }
  void add(const std::string& name, const Json& value, const std::string& words);
  /// Adds a table to the text: a title and rows with aligned columns. Adds nothing if there are no rows.
  void add_table(const std::string& title, const std::vector<Row>& rows);
  void print() const;
};

/// The text or value as JSON; null if the text is empty, or if there is no value.
inline Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }
template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
Json to_json(const OptionValue& value);

/// The JSON array [convert(item), ...].
template <class List, class Convert>
Json list_json(const List& items, const Convert& convert) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(convert(item));
  return list;
}

/// JSON object {name: value, ...}. The names are the members `name` of the items; the values have the same order.
template <class Named>
Json values_by_name(const Named& named, std::span<const double> values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) object[named[i].name] = values[i];
  return object;
}
Json values_by_name(const std::vector<std::pair<std::string, double>>& values);
/// Table rows with the name and the text of each value.
std::vector<Row> value_rows(const std::vector<std::pair<std::string, double>>& values);

}  // namespace pkm
