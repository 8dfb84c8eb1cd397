// Which coordinates a survey sweeps, and which it holds where: keys of [workspace] and [[region]].
#pragma once

#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

inline const AxisInfo& axis_of(const MechanismInfo& info, int coordinate) {
  return info.coordinates[static_cast<std::size_t>(coordinate)];
}
/// Of coordinates, by their numbers.
std::vector<std::string> coordinate_names(const MechanismInfo& info, const std::vector<int>& coordinates);

/// What an angle has to be. A bare number beyond pi was most likely meant in degrees.
std::string angle_expectation(const ConfigValue& written, double value);

/// The coordinates that some sweep holds, those of the usual one first.
std::vector<int> holdable(const MechanismInfo& info);
/// The coordinates that a survey sweeps, in any order.
void read_sweep(const ConfigValue& list, const MechanismInfo& info, WorkspacePlan& plan);
/// The coordinates, of those that the mechanism's surveys can hold, that the study names.
void read_held_coordinates(const ConfigValue& table, const MechanismInfo& info, bool of_region, WorkspacePlan& plan);

}  // namespace pkm
