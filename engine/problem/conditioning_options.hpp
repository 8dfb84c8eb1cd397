// What all quantities that read the conditioning of poses have in common.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

inline bool has_jacobian(const Mechanism& mechanism) { return !mechanism.info().characteristic_length.empty(); }

inline OptionSpec characteristic_length_option() {
  return {.name = "characteristic_length",
          .kind = OptionKind::number,
          .unit = "m",
          .lower = 1e-6,
          .upper = 1e6,
          .meaning = "length that the Jacobian's angular column is divided by; default: the mechanism's own"};
}

/// @param value  the name of the value with kinks
inline OptionSpec sharpness_option(const std::string& value) {
  return {.name = "sharpness",
          .kind = OptionKind::number,
          .initial = 200.0,
          .lower = 1,
          .upper = 1e6,
          .meaning = "of the smooth stand-in for " + value + " that gradient solvers are given: larger is nearer"};
}

inline void demand_conditioning(const EntryContext& context, Demand& demand) {
  demand.conditioning = true;
  if (context.options.has("characteristic_length"))
    demand.characteristic_length = context.options.number("characteristic_length");
}

}  // namespace pkm
