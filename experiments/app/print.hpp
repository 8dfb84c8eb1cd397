// Output of results as text and as JSON: formatted numbers, aligned tables.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/catalogue.hpp"
#include "engine/core/display_unit.hpp"
#include "engine/core/formatted.hpp"
#include "engine/core/options.hpp"
#include "engine/core/text_table.hpp"

namespace pkm {

/// JSON with keys in the order of insertion; numbers that are not finite are printed as null.
using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

// Numbers for people have the units that people use and four significant digits; --digits changes their number. JSON,
// CSV and other files have SI units and all digits.

inline constexpr int kDefaultDigits = 4, kFullDigits = 17;  ///< kFullDigits: as many as reproduce the number
/// Sets the number of significant digits of all texts (--digits).
void use_digits(int count);
/// The number of significant digits of a text.
/// @param known  digits of the value that are known; more are printed only on request (--digits)
int significant_digits(int known = kFullDigits);

/// The unit in which people read an objective, output or constraint of a study; rad is not converted to degrees,
/// because it is seldom an angle: a workspace ratio over x, z and theta, for example, has this unit.
DisplayUnit result_unit(std::string_view si_unit, double magnitude);

/// Text of a number without a unit. A number below 1e7 has at least the digits before its decimal point: "12412".
/// "-" for NaN.
/// @param least  minimum number of significant digits
std::string digits(double value, int least = 1);
/// Text of a number without a unit, with the sign of positive numbers: "+0.25".
std::string signed_digits(double value);
/// Text of a number with the unit that suits it: "302.1 mm", "0.3021"; "not computed" for NaN.
/// @param known  digits of the value that are known
std::string number(double value, std::string_view unit = "1", int known = kFullDigits);
/// Text of a number in a given unit.
std::string in_unit(double value, const DisplayUnit& unit, int known = kFullDigits);
/// Text of an objective, output or constraint of a study with its unit.
inline std::string result_text(double value, std::string_view si_unit, int known = kFullDigits) {
  return in_unit(value, result_unit(si_unit, value), known);
}
/// Text of a number rounded down (direction < 0) or up (direction > 0) to `count` significant digits.
std::string directed_digits(double value, int count, int direction);
/// Texts of a proven lower and upper bound with one digit more than distinguishes them, rounded outwards.
std::array<std::string, 2> bounds_text(double lower, double upper, std::string_view unit);
/// Text of a range in the unit that suits its larger end: "-250 .. 250 mm".
std::string range_text(double lower, double upper, std::string_view unit);
/// Number of significant digits that a voxel count supports. Its relative error is about that of a random count of the
/// boundary cells, N^(-(d + 1) / (2 d)) for N feasible cells in d dimensions.
int known_digits_of_voxels(std::int64_t feasible_cells, std::size_t dimensions);
/// "volume"; "area" if only two coordinates are swept, "length" if only one is.
std::string measure_name(std::size_t swept);

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

}  // namespace pkm
