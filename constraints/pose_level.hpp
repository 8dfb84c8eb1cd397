// What the pose-level constraints share: the limits of the mechanism that a constraint owns.
#pragma once

#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// "" or a sentence: the mechanism has no limit that the constraint owns.
inline std::string refuse_without_limits(const Mechanism& mechanism, const std::string& constraint) {
  for (const auto& limit : mechanism.info().limits)
    if (limit.group == constraint) return {};
  return "constraint " + constraint + " needs limits of its kind, and mechanism " + mechanism.info().name + " has none";
}

}  // namespace pkm
