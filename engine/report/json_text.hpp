// JSON that may stand inside an HTML page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pkm {

/// The JSON's text in ASCII, without any "<": whatever a study is called, it cannot end the script element that holds
/// it. Text that is no UTF-8 gets replacement characters; numbers that are not finite become null.
template <class Json>
std::string json_text(const Json& json) {
  std::string safe;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

/// How the page knows coordinates and joints: { name, unit, role }, the role being what a coordinate is in the room,
/// "x", "y" or "z" for the length of that name, "turn" for an angle, else "other".
template <class Json>
Json axis_data(const std::string& name, const std::string& unit) {
  const bool in_room = name == "x" || name == "y" || name == "z";
  return {{"name", name}, {"unit", unit}, {"role", unit == "rad" ? "turn" : in_room ? name : "other"}};
}
template <class Json, class Axes>
Json axes_data(const Axes& axes) {
  Json list = Json::array();
  for (const auto& axis : axes) list.push_back(axis_data<Json>(axis.name, axis.unit));
  return list;
}

/// {"name": text, ...} of JSON texts; empty ones are left out.
inline std::string json_object(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string object;
  for (const auto& [name, text] : members)
    if (!text.empty()) object += (object.empty() ? "{\"" : ",\"") + name + "\":" + text;
  return object.empty() ? "{}" : object + '}';
}

}  // namespace pkm
