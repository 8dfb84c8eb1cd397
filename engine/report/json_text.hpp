// JSON text that is safe inside a script element of an HTML page, and JSON objects that several panels share.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "engine/problem/diagnosis.hpp"

namespace pkm {

using Json = nlohmann::ordered_json;

/// Serialises JSON as ASCII without "<", so that no text of a study can end the script element that contains it.
/// Invalid UTF-8 is replaced by U+FFFD; non-finite numbers become null.
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

/// JSON object of a coordinate or a joint: { name, unit, role }. The role is "rotation" for an angle, the name itself
/// for the Cartesian coordinates "x", "y" and "z", and "other" for any other length.
inline Json axis_data(const std::string& name, const std::string& unit) {
  const bool is_cartesian = name == "x" || name == "y" || name == "z";
  return {{"name", name}, {"unit", unit}, {"role", unit == "rad" ? "rotation" : is_cartesian ? name : "other"}};
}
template <class Axes>
Json axes_data(const Axes& axes) {
  Json list = Json::array();
  for (const auto& axis : axes) list.push_back(axis_data(axis.name, axis.unit));
  return list;
}

/// JSON array with an object { name, unit, meaning } for each element of `infos`.
template <class Infos>
Json infos_json(const Infos& infos) {
  Json list = Json::array();
  for (const auto& info : infos) list.push_back({{"name", info.name}, {"unit", info.unit}, {"meaning", info.meaning}});
  return list;
}

/// JSON array with an object { kind, names, sentence } for each reason.
inline Json reasons_json(const std::vector<Reason>& reasons) {
  Json list = Json::array();
  for (const Reason& reason : reasons)
    list.push_back({{"kind", reason.kind}, {"names", reason.names}, {"sentence", reason.sentence}});
  return list;
}
/// JSON object { finding, sentence, reasons } of a diagnosis; null if there is none.
inline Json diagnosis_json(const std::optional<Diagnosis>& diagnosis) {
  if (!diagnosis) return Json();
  return {{"finding", diagnosis->finding},
          {"sentence", diagnosis->sentence},
          {"reasons", reasons_json(diagnosis->reasons)}};
}

}  // namespace pkm
