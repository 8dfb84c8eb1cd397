// Motor selection: demand of a joint's motion compared with the ratings of a motor.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/drive_train.hpp"

namespace pkm {

/// A point of the curve of peak torque over speed.
struct TorqueAtSpeed {
  double speed = 0, torque = 0;  ///< [rad/s, N m]
};

/// Ratings of a motor.
struct Motor {
  std::string name;
  double continuous_torque = 0, peak_torque = 0;  ///< > 0 [N m]
  double speed = 0;                               ///< maximum speed, > 0 [rad/s]
  double rotor = 0;                               ///< inertia of the rotor [kg m^2]
  /// Curve of the peak torque over the speed, linear between its points and constant outside of them; speeds increase
  /// strictly. Empty: the peak torque is constant.
  std::vector<TorqueAtSpeed> curve = {};

  /// Peak torque at a speed of either sign [N m].
  template <class S>
  S torque_at(const S& speed_of_motor) const {
    if (curve.empty()) return S(peak_torque);
    const S w = magnitude(speed_of_motor);
    const auto after =
        std::find_if(curve.begin(), curve.end(), [&](const TorqueAtSpeed& p) { return p.speed > value_of(w); });
    if (after == curve.begin()) return S(after->torque);
    if (after == curve.end()) return S(curve.back().torque);
    const TorqueAtSpeed &low = *(after - 1), &high = *after;
    return (w - low.speed) * ((high.torque - low.torque) / (high.speed - low.speed)) + low.torque;
  }
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
