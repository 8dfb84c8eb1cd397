// JSON that may stand inside an HTML page.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "engine/problem/verdict.hpp"

namespace pkm {

using Json = nlohmann::ordered_json;

/// The JSON's text in ASCII, without any "<": whatever a study is called, it cannot end the script element that holds
/// it. Text that is no UTF-8 gets replacement characters; numbers that are not finite become null.
inline std::string json_text(const Json& json) {
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
inline Json axis_data(const std::string& name, const std::string& unit) {
  const bool in_room = name == "x" || name == "y" || name == "z";
  return {{"name", name}, {"unit", unit}, {"role", unit == "rad" ? "turn" : in_room ? name : "other"}};
}
template <class Axes>
Json axes_data(const Axes& axes) {
  Json list = Json::array();
  for (const auto& axis : axes) list.push_back(axis_data(axis.name, axis.unit));
  return list;
}

/// { name, unit, meaning } of each.
template <class Infos>
Json named(const Infos& infos) {
  Json list = Json::array();
  for (const auto& info : infos) list.push_back({{"name", info.name}, {"unit", info.unit}, {"meaning", info.meaning}});
  return list;
}

/// { kind, names, sentence } of each.
inline Json reasons_json(const std::vector<Reason>& reasons) {
  Json list = Json::array();
  for (const Reason& reason : reasons)
    list.push_back({{"kind", reason.kind}, {"names", reason.names}, {"sentence", reason.sentence}});
  return list;
}
/// { finding, sentence, reasons }; null for none.
inline Json verdict_json(const std::optional<Verdict>& verdict) {
  if (!verdict) return Json();
  return {{"finding", verdict->finding}, {"sentence", verdict->sentence}, {"reasons", reasons_json(verdict->reasons)}};
}

}  // namespace pkm
