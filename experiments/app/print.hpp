// Printing of results: numbers with a useful number of digits, aligned columns, JSON.
#pragma once

#include <optional>
#include <ostream>
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

/// As std::printf has it; "-" for NaN.
std::string formatted(const char* format, double value);
/// Ten significant digits; "-" for NaN.
inline std::string digits(double value) { return formatted("%.10g", value); }

/// Aligned rows under a title on a line of its own; nothing when there are none.
void print_section(std::ostream& out, std::string_view title, const std::vector<Row>& rows);

void print_json(std::ostream& out, const Json& json);
/// Null for no text, or for no value.
inline Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }
template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
Json to_json(const OptionValue& value);

/// {name: value, ...} of things with a name and their values, in one order.
template <class Named>
Json values_by_name(const Named& named, std::span<const double> values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) object[named[i].name] = values[i];
  return object;
}
Json values_by_name(const std::vector<std::pair<std::string, double>>& values);

}  // namespace pkm
