// Helpers of the pose-level constraints. Such a constraint sets the limits of one group (LimitInfo::group).
#pragma once

#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Indices of the mechanism's limits whose group is the constraint.
inline std::vector<std::size_t> limits_of(const MechanismInfo& mechanism, const std::string& constraint) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < mechanism.limits.size(); ++i)
    if (mechanism.limits[i].group == constraint) indices.push_back(i);
  return indices;
}

/// Capability check of a constraint: the mechanism must have a limit that belongs to the constraint.
inline auto check_limits(const std::string& constraint) {
  return [constraint](const Mechanism& mechanism) -> Unsupported {
    if (!limits_of(mechanism.info(), constraint).empty()) return {};
    return "constraint " + constraint + " sets limits that mechanism " + mechanism.info().name + " does not have";
  };
}

}  // namespace pkm
