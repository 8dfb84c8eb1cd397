// Motor selection: demand of a joint's motion compared with the ratings of a motor.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/drive_train.hpp"

namespace pkm {

/// Ratings of a motor.
struct Motor {
  std::string name;
  double continuous_torque = 0, peak_torque = 0;  ///< > 0 [N m]
  double speed = 0;                               ///< maximum speed, > 0 [rad/s]
  double rotor = 0;                               ///< inertia of the rotor [kg m^2]
};

/// Force, speed and acceleration of a joint at one time.
struct JointLoad {
  double force;                ///< without friction and without reflected inertia [N, N m]
  double speed, acceleration;  ///< [m/s, rad/s; m/s^2, rad/s^2]
};

/// The demand on a motor, and its reserve.
struct MotorFit {
  double peak_torque = 0, rms_torque = 0, speed = 0;  ///< required [N m, N m, rad/s]
  double reserve = 0;      ///< minimum ratio of rating to demand; the motor is sufficient if >= 1
  std::string bounded_by;  ///< the rating with the minimum ratio: "peak torque", "continuous torque" or "speed"
};

/// Compares the demand of a motion with the ratings of a motor.
/// @param train  drive train of the joint; its rotor inertia is replaced by that of the motor
/// @param loads  loads of the joint at equidistant times, at least one
MotorFit fit(const Motor& motor, DriveTrain train, std::span<const JointLoad> loads);

}  // namespace pkm
