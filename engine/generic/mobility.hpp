// Instantaneous mobility of the platform: the null space of the velocity constraints of all joints that a file
// describes, the drives free.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::generic {

/// Degrees of freedom that the joints of the limbs leave the platform while the drives move freely.
struct PlatformMobility {
  std::size_t of_joints;  ///< dimension of the platform's twists that the joints allow
  /// Dimension of those among them that the coordinates describe; none: formulas of the limbs' ends do not say how the
  /// platform moves.
  std::optional<std::size_t> of_coordinates;
  /// Those that the joints allow and no coordinate describes, "rotation about z"; empty: none, or not along the axes.
  std::vector<std::string> assumed;
};

/// At a pose that assembles, of a model whose joints are described.
PlatformMobility mobility_at(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                             std::size_t mode);

/// The same of a mechanism that a file describes; none where the file does not describe the joints.
/// @param mode  one of MechanismInfo::modes
std::optional<PlatformMobility> platform_mobility(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const Pose<double>& pose, const std::string& mode);

}  // namespace pkm::generic
