// What the pose-level constraints share: the limits of the mechanism that a constraint owns.
#pragma once

#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The limits that the constraint owns, as indices.
inline std::vector<std::size_t> limits_of(const MechanismInfo& mechanism, const std::string& constraint) {
  std::vector<std::size_t> owned;
  for (std::size_t i = 0; i < mechanism.limits.size(); ++i)
    if (mechanism.limits[i].group == constraint) owned.push_back(i);
  return owned;
}

/// Why a mechanism cannot serve the constraint: it has no limit that the constraint owns.
inline auto refuse_without_limits(const std::string& constraint) {
  return [constraint](const Mechanism& mechanism) -> Refusal {
    if (!limits_of(mechanism.info(), constraint).empty()) return {};
    return "constraint " + constraint + " needs limits of its kind, and mechanism " + mechanism.info().name +
           " has none";
  };
}

}  // namespace pkm
