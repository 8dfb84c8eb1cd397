#include "experiments/app/print.hpp"

#include <cmath>
#include <iostream>
#include <numbers>

#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

std::string number(double value, std::string_view unit) {
  if (std::isnan(value)) return "not computed";
  std::string text = formatted("%.12g", value);
  if (unit != "1" && !unit.empty()) text += " " + std::string(unit);
  return text;
}

std::string position(double value, std::string_view unit) { return number(value, unit) + in_degrees(value, unit); }

DisplayUnit display_unit(const std::string& si_unit) {
  if (si_unit == "m") return {1e-3, "mm"};
  if (si_unit == "rad") return {std::numbers::pi / 180, "deg"};
  return {1, si_unit};
}

void print_json(const Json& json) {
  // Names and file names may contain bytes that are not UTF-8, which JSON forbids and which are therefore replaced. If
  // strings contain control characters that JSON permits, all characters outside ASCII are escaped.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
  const bool plain = printable(text, "\n") == text;
  std::cout << (plain ? text : json.dump(2, ' ', true, Json::error_handler_t::replace)) << '\n';
}

void Printout::add(const std::string& name, const Json& value, const std::string& words) {
  json[name] = value;
  head.push_back({name, words});
}

void Printout::add_table(const std::string& title, const std::vector<Row>& rows) {
  if (!rows.empty()) text += '\n' + title + '\n' + aligned(rows);
}

void Printout::print() const {
  if (as_json && !json_lines.empty()) {
    for (const Json& line : json_lines) std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else if (as_json) {
    print_json(json);
  } else {
    std::cout << aligned(head) << text;
  }
}

Json values_by_name(const std::vector<std::pair<std::string, double>>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

std::vector<Row> value_rows(const std::vector<std::pair<std::string, double>>& values) {
  std::vector<Row> rows;
  for (const auto& [name, value] : values) rows.push_back({name, number(value)});
  return rows;
}

Json to_json(const OptionValue& value) {
  const auto convert = [](const auto& item) {
    if constexpr (std::is_same_v<std::decay_t<decltype(item)>, NamedSettings>) {
      Json json = Json::object();
      for (const auto& [name, setting] : item) json[name] = std::visit([](const auto& v) { return Json(v); }, setting);
      return json;
    } else {
      return Json(item);
    }
  };
  return std::visit(convert, value);
}

}  // namespace pkm
