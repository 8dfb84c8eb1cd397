// Helper functions that build the option specifications of an optimiser's catalogue entry.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/core/options.hpp"

namespace pkm {

/// An option whose value is a dimensionless number in [lower, upper]. Without an initial value, the option is optional
/// and has no default.
inline OptionSpec number_option(std::string name, std::optional<OptionValue> initial, double lower, double upper,
                                std::string meaning) {
  return {.name = std::move(name),
          .kind = OptionKind::number,
          .initial = std::move(initial),
          .lower = lower,
          .upper = upper,
          .meaning = std::move(meaning)};
}

inline OptionSpec integer_option(std::string name, std::optional<OptionValue> initial, double lower, double upper,
                                 std::string meaning) {
  OptionSpec spec = number_option(std::move(name), std::move(initial), lower, upper, std::move(meaning));
  spec.kind = OptionKind::integer;
  return spec;
}

/// An option whose value is one of `choices`; the first is the default.
inline OptionSpec word_option(std::string name, std::vector<std::string> choices, std::string meaning) {
  return {.name = std::move(name),
          .kind = OptionKind::word,
          .initial = choices.front(),
          .choices = std::move(choices),
          .meaning = std::move(meaning)};
}

inline OptionSpec flag_option(std::string name, bool initial, std::string meaning) {
  return {.name = std::move(name), .kind = OptionKind::flag, .initial = initial, .meaning = std::move(meaning)};
}

}  // namespace pkm
