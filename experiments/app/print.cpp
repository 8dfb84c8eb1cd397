#include "experiments/app/print.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace pkm {

std::string formatted(const char* format, double value) {
  if (std::isnan(value)) return "-";
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

std::string number(double value, std::string_view unit) {
  if (std::isnan(value)) return "not computed";
  std::string text = formatted("%.12g", value);
  if (unit != "1" && !unit.empty()) text += " " + std::string(unit);
  return text;
}

void print_section(std::ostream& out, std::string_view title, const std::vector<Row>& rows) {
  if (rows.empty()) return;
  out << '\n' << title << '\n' << aligned(rows);
}

void print_json(std::ostream& out, const Json& json) {
  // Names and file names may hold bytes that are no UTF-8; JSON may not.
  out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

Json values_by_name(const std::vector<std::pair<std::string, double>>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

Json to_json(const OptionValue& value) {
  if (const auto* settings = std::get_if<NamedSettings>(&value)) {
    Json json = Json::object();
    for (const auto& [name, setting] : *settings)
      json[name] = std::visit([](const auto& v) { return Json(v); }, setting);
    return json;
  }
  return std::visit(
      [](const auto& v) {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, NamedSettings>)
          return Json();
        else
          return Json(v);
      },
      value);
}

}  // namespace pkm
