// Limits of actuated joints and their motors, within which motions are made as fast as possible.
#pragma once

#include <limits>
#include <optional>

#include "engine/dynamics/motor.hpp"

namespace pkm {

/// Limits of one joint. They are > 0; infinity means unlimited.
struct JointLimits {
  double speed = std::numeric_limits<double>::infinity();         ///< maximum |qdot| [m/s, rad/s]
  double acceleration = std::numeric_limits<double>::infinity();  ///< maximum |qddot| [m/s^2, rad/s^2]
  double force = std::numeric_limits<double>::infinity();         ///< maximum |tau| [N, N m]
  std::optional<Motor> motor = {};  ///< ratings of the motor; std::nullopt: no limit by a motor
};

}  // namespace pkm
