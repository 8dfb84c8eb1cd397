// Short ways to write the options of an optimiser's catalogue entry.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/core/options.hpp"

namespace pkm {

/// An option without unit in [lower, upper]. No initial value: the option may be absent.
inline OptionSpec number_option(std::string name, std::optional<OptionValue> initial, double lower, double upper,
                                std::string meaning) {
  return {std::move(name), OptionKind::number, "1", std::move(initial), false, lower, upper, {}, std::move(meaning)};
}

inline OptionSpec integer_option(std::string name, std::optional<OptionValue> initial, double lower, double upper,
                                 std::string meaning) {
  return {std::move(name), OptionKind::integer, "1", std::move(initial), false, lower, upper, {}, std::move(meaning)};
}

/// The first choice is the default.
inline OptionSpec word_option(std::string name, std::vector<std::string> choices, std::string meaning) {
  OptionSpec spec;
  spec.name = std::move(name);
  spec.kind = OptionKind::word;
  spec.initial = choices.front();
  spec.choices = std::move(choices);
  spec.meaning = std::move(meaning);
  return spec;
}

inline OptionSpec flag_option(std::string name, bool initial, std::string meaning) {
  OptionSpec spec;
  spec.name = std::move(name);
  spec.kind = OptionKind::flag;
  spec.initial = initial;
  spec.meaning = std::move(meaning);
  return spec;
}

}  // namespace pkm
