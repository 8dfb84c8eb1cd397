// Compliance of the platform at a pose: elasticity of drives, rods, legs and cranks.
#pragma once

#include <span>
#include <string>

#include "engine/geometry/pose.hpp"

namespace pkm {

/// Displacements by wrenches: three components along x, y, z of the base frame, then three about them, at the origin of
/// the platform's frame.
struct PlatformCompliance {
  AxisMatrix<double> supported;   ///< 6 x k, orthonormal columns: wrenches that the mechanism carries in equilibrium
  AxisMatrix<double> compliance;  ///< k x k, by these wrenches [m/N, rad/(N m), ..]

  /// Whether all wrenches are carried, and `supported` is the identity; otherwise the platform is free in some
  /// direction, or the pose is singular.
  bool is_complete() const { return supported.cols() == 6; }
};

class Elasticity {
 public:
  virtual ~Elasticity() = default;
  /// @param pose  assembles
  virtual PlatformCompliance compliance(std::span<const double> parameters, const Pose<double>& pose,
                                        const std::string& mode) const = 0;
};

}  // namespace pkm
