// Proven bounds of volumes that are computed by columns.
#pragma once

#include <optional>
#include <span>

#include "engine/math/interval.hpp"

namespace pkm {

/// A WorkspaceEvaluator that can prove bounds of a volume implements this interface, too.
class VolumeProver {
 public:
  virtual ~VolumeProver() = default;
  /// Bounds of the volume of a design, which hold in spite of rounding and quadrature; std::nullopt if they cannot be
  /// proven. The parameters are exactly the given numbers.
  virtual std::optional<Interval> proven_volume(std::span<const double> parameters) const = 0;
};

}  // namespace pkm
