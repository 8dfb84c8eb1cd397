// The solution of the forward kinematics that is closest to a pose.
#pragma once

#include <optional>
#include <span>

#include "engine/mechanism/abilities/kinematics.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The assembly mode closest to the pose `from` (Euclidean distance, 1 m counts as 1 rad), whether usual or not, among
/// the assembly modes that a search from this pose finds. std::nullopt if there is none, or if the mechanism has no
/// forward kinematics.
std::optional<AssemblyMode> nearest_assembly(const Mechanism& mechanism, std::span<const double> parameters,
                                             const AxisVector<double>& joints, const Pose<double>& from);

}  // namespace pkm
