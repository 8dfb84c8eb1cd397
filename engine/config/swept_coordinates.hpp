// Reads the swept and the fixed coordinates of [workspace] and [[region]].
#pragma once

#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

inline const AxisInfo& axis_of(const MechanismInfo& info, int coordinate) {
  return info.coordinates[static_cast<std::size_t>(coordinate)];
}
/// Names of the coordinates with these indices.
std::vector<std::string> coordinate_names(const MechanismInfo& info, const std::vector<int>& coordinates);

/// Text for messages: which angles are valid. A number beyond pi without a unit was probably meant in degrees.
std::string angle_expectation(const ConfigValue& written, double value);

/// The coordinates that are fixed in at least one sweep of the mechanism, beginning with those that the default sweep
/// fixes.
std::vector<int> fixable(const MechanismInfo& info);
/// Reads the list of swept coordinates, in any order.
void read_sweep(const ConfigValue& list, const MechanismInfo& info, WorkspacePlan& plan);
/// Reads the fixed coordinates that the study names.
void read_fixed_coordinates(const ConfigValue& table, const MechanismInfo& info, bool of_region, WorkspacePlan& plan);

}  // namespace pkm
