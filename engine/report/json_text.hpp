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

/// {"name": text, ...} of JSON texts; empty ones are left out.
inline std::string json_object(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string object;
  for (const auto& [name, text] : members)
    if (!text.empty()) object += (object.empty() ? "{\"" : ",\"") + name + "\":" + text;
  return object.empty() ? "{}" : object + '}';
}

}  // namespace pkm
