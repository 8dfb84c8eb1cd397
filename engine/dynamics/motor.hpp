// Motors, and which of them do what a joint is asked for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/drive_train.hpp"

namespace pkm {

struct Motor {
  std::string name;
  double continuous_torque = 0, peak_torque = 0;  ///< > 0 [N m]
  double speed = 0;                               ///< the greatest, > 0 [rad/s]
  double rotor = 0;                               ///< inertia [kg m^2]
};

/// What a joint does at one time.
struct JointLoad {
  double force;  ///< without friction and without reflected inertia [N, N m]
  double speed, acceleration;
};

/// What a motor would have to do, and how far it is from its limits.
struct MotorFit {
  double peak_torque = 0, rms_torque = 0, speed = 0;
  double reserve = 0;      ///< least ratio of what the motor can to what is asked; it does the motion where >= 1
  std::string bounded_by;  ///< "peak torque", "continuous torque" or "speed": what the reserve is that of
};

/// @param train  of the joint; the motor's rotor takes the place of its own
/// @param loads  at equal distances in time, at least one
MotorFit fit(const Motor& motor, DriveTrain train, std::span<const JointLoad> loads);

}  // namespace pkm
