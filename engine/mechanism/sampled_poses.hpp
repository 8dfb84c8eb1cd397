// Poses that fill the search box of a workspace evenly, and a feasible one in the middle of the workspace.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Sequence of poses in the ranges of the coordinates (Halton sequence). Coordinates that the default workspace does
/// not sweep have their default values, if there are any: far away from all of them hardly any pose is feasible.
class SampledPoses {
 public:
  /// Throws DesignError if the ranges of the coordinates are unknown.
  /// @param reach  how far a coordinate that is not swept may be from its default value, relative to its range
  SampledPoses(const Mechanism& mechanism, std::span<const double> parameters, double reach = 0);

  /// @param index  from 1
  Pose<double> operator[](std::size_t index) const;
  const std::vector<std::array<double, 2>>& ranges() const { return ranges_; }

 private:
  std::vector<std::array<double, 2>> ranges_;
};

/// The one of the first feasible poses of the sequence that is closest to their mean, by differences relative to the
/// ranges of the coordinates; std::nullopt if none was found or the ranges are unknown.
/// @param mode  one of MechanismInfo::modes
std::optional<Pose<double>> central_pose(const Mechanism& mechanism, std::span<const double> parameters,
                                         const LimitSpec& limits, const std::string& mode);

}  // namespace pkm
