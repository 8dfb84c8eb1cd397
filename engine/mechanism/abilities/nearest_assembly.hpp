// The solution of the forward kinematics that is closest to a pose.
#pragma once

#include <optional>
#include <span>

#include "engine/mechanism/abilities/kinematics.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Finds the assembly mode that is closest to the pose `from` (Euclidean distance of the coordinates, in which 1 m
/// counts as 1 rad), among those that a search from this pose finds. std::nullopt if the search finds none, or if the
/// mechanism has no forward kinematics.
std::optional<AssemblyMode> nearest_assembly(const Mechanism& mechanism, std::span<const double> parameters,
                                             const AxisVector<double>& joints, const Pose<double>& from);

}  // namespace pkm
