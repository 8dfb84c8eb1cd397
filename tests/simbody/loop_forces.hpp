// Forces of the drives of a closed-loop system of Simbody whose platform moves as told. Rates and accelerations are
// solved from its constraints, forces from its equations of motion; where constraints are redundant, by least norm.
#pragma once

#include <Simbody.h>
#include <Eigen/QR>
#include <array>
#include <vector>

namespace pkm::simbody {

/// Angular velocity and velocity of the platform's origin: those with these numbers, 0 to 5, and their rates.
struct PlatformMotion {
  std::vector<int> rows;
  Eigen::VectorXd velocity, acceleration;
};

struct LoopForces {
  Eigen::VectorXd drives;       ///< [N, N m]
  Eigen::VectorXd multipliers;  ///< of the constraints: of a ball the force along x, y, z of the ground
  int constraints = 0, constraint_rank = 0;
  double open = 0;        ///< greatest error of the loops' closure, as given and in rates [m, rad; per s, per s^2]
  double unbalanced = 0;  ///< greatest residual of the equations of motion [N, N m]
};

/// @param state    with the positions
/// @param station  of the platform, where the wrench (force, moment) acts
/// @param drives   bodies whose first mobility a drive moves
LoopForces loop_forces(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
                       SimTK::State state, const SimTK::MobilizedBody& platform, const PlatformMotion& motion,
                       const SimTK::Vec3& station, const std::array<double, 6>& wrench,
                       const std::vector<SimTK::MobilizedBody>& drives);

}  // namespace pkm::simbody
