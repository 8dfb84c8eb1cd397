// Evenly distributed sample poses in the search box of a workspace, and a feasible pose in the middle of the workspace.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Halton sequence of poses in the ranges of the coordinates. Coordinates that the default workspace does not sweep
/// stay at or near their default values, if they have any, because hardly any pose would be feasible otherwise.
class SampledPoses {
 public:
  /// Throws DesignError if the ranges of the coordinates are unknown.
  /// @param reach  maximum distance of a coordinate that is not swept from its default value, relative to its range
  SampledPoses(const Mechanism& mechanism, std::span<const double> parameters, double reach = 0);

  /// @param index  number of the pose in the sequence, >= 1
  Pose<double> operator[](std::size_t index) const;
  const std::vector<std::array<double, 2>>& ranges() const { return ranges_; }

 private:
  std::vector<std::array<double, 2>> ranges_;
};

/// Finds a feasible pose in the middle of the workspace: among the first feasible poses of a SampledPoses sequence, the
/// one that is closest to their mean, relative to the ranges of the coordinates. std::nullopt if no feasible pose was
/// found, or if the ranges are unknown.
/// @param mode  one of MechanismInfo::modes
std::optional<Pose<double>> central_pose(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode);

}  // namespace pkm
