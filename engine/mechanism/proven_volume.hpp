// Interface of workspace analyses by columns that can prove bounds of the volumes they compute.
#pragma once

#include <optional>
#include <span>

#include "engine/math/interval.hpp"

namespace pkm {

/// Interface of a WorkspaceEvaluator that can prove bounds of the volume.
class VolumeProver {
 public:
  virtual ~VolumeProver() = default;
  /// Computes bounds between which the volume of a design lies in spite of rounding and quadrature errors; std::nullopt
  /// if they cannot be proven. The parameters are taken as exact numbers.
  virtual std::optional<Interval> proven_volume(std::span<const double> parameters) const = 0;
};

}  // namespace pkm
