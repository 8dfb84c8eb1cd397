// Instantaneous mobility of the platform: null space of the velocity constraints of all joints, with free drives.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::generic {

/// Degrees of freedom of the platform that the joints allow if the drives move freely.
struct PlatformMobility {
  std::size_t of_joints;  ///< number of independent platform twists that the joints allow, with free drives
  /// Dimension of the space of those platform twists that changes of the coordinates produce; std::nullopt if the ends
  /// of the limbs are given by formulas that are inconsistent with the motion of the platform frame.
  std::optional<std::size_t> of_coordinates;
  /// Descriptions of twists that the joints allow but changes of the coordinates do not produce, such as "rotation
  /// about z". Empty if there are none, or if they are not along coordinate axes.
  std::vector<std::string> assumed;
};

/// The mobility at a pose that assembles, for a model with Model::jointed.
PlatformMobility mobility_at(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                             std::size_t mode);

/// The mobility of a mechanism; std::nullopt if the mechanism is not from a file, or its file does not describe the
/// joints.
/// @param mode  working mode, one of MechanismInfo::modes
std::optional<PlatformMobility> platform_mobility(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const Pose<double>& pose, const std::string& mode);

}  // namespace pkm::generic
