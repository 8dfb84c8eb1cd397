// Inverse dynamics of a closed-loop Simbody system whose platform motion is prescribed. Velocities and accelerations
// are solved from the constraints, forces from the equations of motion; with redundant constraints, by minimum norm.
#pragma once

#include <Simbody.h>
#include <Eigen/QR>
#include <array>
#include <vector>

namespace pkm::simbody {

/// Prescribed components of the platform's twist (0 to 2: angular velocity, 3 to 5: velocity of the origin) and of its
/// time derivative.
struct PlatformMotion {
  std::vector<int> rows;  ///< indices of the prescribed components
  Eigen::VectorXd velocity, acceleration;
};

struct LoopForces {
  Eigen::VectorXd drives;       ///< [N, N m]
  Eigen::VectorXd multipliers;  ///< of the constraints; for a ball the force along x, y, z of the ground frame
  int constraints = 0, constraint_rank = 0;
  double closure_error = 0;  ///< maximum residual of the loop-closure equations and their time derivatives (SI units)
  double force_error = 0;    ///< maximum residual of the equations of motion [N, N m]
};

/// @param state    contains the positions
/// @param station  point in the platform frame where the wrench (force, moment) acts
/// @param drives   bodies whose first mobility is driven
LoopForces loop_forces(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
                       SimTK::State state, const SimTK::MobilizedBody& platform, const PlatformMotion& motion,
                       const SimTK::Vec3& station, const std::array<double, 6>& wrench,
                       const std::vector<SimTK::MobilizedBody>& drives);

}  // namespace pkm::simbody
