// A feasible pose in the middle of the workspace, as the reference pose of models and drawings.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The one of a fixed sequence of feasible poses that is closest to their mean, by differences relative to the ranges
/// of the coordinates. Coordinates that the default workspace does not sweep have their default values, if there are
/// any. std::nullopt if the ranges of the coordinates are unknown or no feasible pose was found.
/// @param mode  one of MechanismInfo::modes
std::optional<Pose<double>> central_pose(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode);

}  // namespace pkm
