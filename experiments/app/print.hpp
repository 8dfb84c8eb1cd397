// Printing of results: numbers with a useful number of digits, aligned columns, JSON.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/options.hpp"
#include "engine/core/text_table.hpp"

namespace pkm {

/// Keeps the order in which keys are added. Numbers that are not finite are printed as null.
using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

/// A number with its unit, 12 significant digits; "not computed" for NaN.
std::string number(double value, std::string_view unit = "1");
/// The same of a coordinate or a joint, which in degrees is easier to read: "0.349065850399 rad (20 deg)".
std::string position(double value, std::string_view unit);

/// "3.47 rad/m" -> per mm for lengths, per degree for angles: what an engineer thinks in.
struct Step {
  double size;
  std::string unit;
};
Step handy(const std::string& unit);

/// As std::printf has it; "-" for NaN.
std::string formatted(const char* format, double value);
/// Ten significant digits; "-" for NaN.
inline std::string digits(double value) { return formatted("%.10g", value); }

/// Text for an element or an attribute of XML.
std::string xml_text(const std::string& text);

void print_json(const Json& json);

/// What a command tells, each thing said once: as text for people, or as one JSON object for programs.
struct Printout {
  bool for_programs = false;
  std::vector<Row> head = {};  ///< what the text begins with
  std::string text = {};       ///< what follows
  Json json = Json::object();

  void say(const std::string& name, const std::string& word) { say(name, word, word); }
  void say(const std::string& name, const Json& value, const std::string& words);
  /// Aligned rows under a title on a line of its own; nothing when there are none.
  void section(const std::string& title, const std::vector<Row>& rows);
  void print() const;
};

/// Null for no text, or for no value.
inline Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }
template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
Json to_json(const OptionValue& value);

/// A list of what `say` makes of each thing.
template <class List, class Say>
Json list_json(const List& things, const Say& say) {
  Json list = Json::array();
  for (const auto& thing : things) list.push_back(say(thing));
  return list;
}

/// {name: value, ...} of things with a name and their values, in one order.
template <class Named>
Json values_by_name(const Named& named, std::span<const double> values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) object[named[i].name] = values[i];
  return object;
}
Json values_by_name(const std::vector<std::pair<std::string, double>>& values);
/// The same as rows of text.
std::vector<Row> rows_of(const std::vector<std::pair<std::string, double>>& values);

}  // namespace pkm
