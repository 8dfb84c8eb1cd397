// Mechanism files as texts: reading them, changing them, and values of the mechanisms.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <regex>
#include <stdexcept>
#include <string>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/error.hpp"
#include "tests/unit/config/report_at.hpp"

namespace pkm::test {

inline std::shared_ptr<const Mechanism> read_robot(const std::string& text) {
  return read_mechanism_toml(text, "robot.toml");
}

/// The message about a file; "it is accepted" if there is none.
inline std::string refusal_of(const std::string& text) {
  try {
    read_robot(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "it is accepted";
}

/// @param from  a regular expression that the text contains
inline std::string substituted(std::string text, const std::string& from, const std::string& to) {
  const std::regex pattern(from);
  EXPECT_TRUE(std::regex_search(text, pattern)) << from;
  return std::regex_replace(text, pattern, to);
}

inline double value_of(const NamedValues& values, const std::string& name) {
  for (const auto& [each, value] : values)
    if (each == name) return value;
  ADD_FAILURE() << name;
  return NAN;
}

inline double quantity_at(const Mechanism& mechanism, const std::string& name, const Pose<double>& pose) {
  const auto& known = mechanism.info().quantities;
  const auto found = std::ranges::find(known, name, &QuantityInfo::name);
  if (found == known.end()) throw std::logic_error(name);
  return report_at(mechanism, pose).quantities[static_cast<std::size_t>(found - known.begin())];
}

inline std::string why_undefined(const Mechanism& mechanism, const std::string& name) {
  for (const UndefinedQuantity& each : mechanism.info().undefined_quantities)
    if (each.name == name) return each.why;
  return "";
}

}  // namespace pkm::test
