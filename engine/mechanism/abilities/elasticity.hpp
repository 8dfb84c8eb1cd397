// Compliance of the platform at a pose: elasticity of drives, rods, legs and cranks.
#pragma once

#include <span>
#include <string>

#include "engine/geometry/pose.hpp"

namespace pkm {

/// Compliance of the platform: the displacement that a wrench causes. Wrenches and displacements have six components,
/// along and about the x, y and z axes of the base frame, at the origin of the platform frame.
struct PlatformCompliance {
  /// Orthonormal basis of the wrenches that the mechanism can balance, as the columns of a 6 x k matrix.
  AxisMatrix<double> supported;
  AxisMatrix<double> compliance;  ///< k x k, in the basis of the k columns of `supported` [m/N, rad/(N m), ..]

  /// Returns true if the mechanism can balance every wrench; `supported` is then the identity. Otherwise the platform
  /// can move freely in some direction, or the pose is singular.
  bool is_complete() const { return supported.cols() == 6; }
};

class Elasticity {
 public:
  virtual ~Elasticity() = default;
  /// @param pose  the pose, at which the mechanism must be assembled
  virtual PlatformCompliance compliance(std::span<const double> parameters, const Pose<double>& pose,
                                        const std::string& mode) const = 0;
};

}  // namespace pkm
