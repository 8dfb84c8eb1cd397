// Golden data of (3CRR/R)&CRU and the Quadrupteron, converted to command line arguments.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pkm::testing {

inline const nlohmann::json& crr_cru_golden() {
  static const nlohmann::json data =
      nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/3crr-r-cru-and-quadrupteron.json"));
  return data;
}

/// Names and values as "x=0.2,y=0.17".
inline std::string assignments(const std::vector<std::string>& names, const nlohmann::json& values) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : ",") + names[i] + "=" + values[i].dump();
  return text;
}

/// Elbow signs as "-,-,+,-".
inline std::string mode_text(const nlohmann::json& sigma) {
  std::string mode;
  for (const int sign : sigma) mode += std::string(mode.empty() ? "" : ",") + (sign > 0 ? "+" : "-");
  return mode;
}

}  // namespace pkm::testing
