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
  double speed = 0, torque = 0;  ///< speed [rad/s] and peak torque at this speed [N m]
};

/// Ratings of a motor.
struct Motor {
  std::string name;
  /// Largest root-mean-square torque and largest torque of the motor, > 0 [N m].
  double continuous_torque = 0, peak_torque = 0;
  double speed = 0;  ///< maximum speed, > 0 [rad/s]
  double rotor = 0;  ///< inertia of the rotor [kg m^2]
  /// Curve of the peak torque over the speed, linear between its points and constant outside of them; speeds increase
  /// strictly. Empty: the peak torque is constant.
  std::vector<TorqueAtSpeed> curve = {};

  /// The peak torque at a speed [N m]; the sign of the speed has no influence.
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

/// Force, speed and acceleration of a joint at one instant of a motion.
struct JointLoad {
  double force;                ///< force of the joint without friction and without reflected inertia [N, N m]
  double speed, acceleration;  ///< speed [m/s, rad/s] and acceleration [m/s^2, rad/s^2] of the joint
};

/// The demand of a motion on a motor, compared with the motor's ratings.
struct MotorFit {
  /// Peak torque [N m], root-mean-square torque [N m] and motor speed [rad/s] that the motion requires.
  double peak_torque = 0, rms_torque = 0, speed = 0;
  double reserve = 0;  ///< minimum ratio of a rating to the demand; the motor is sufficient if it is >= 1
  /// Rating whose ratio to the demand is smallest: "peak torque", "continuous torque" or "speed".
  std::string bounded_by;
};

/// Compares the demand of a motion with the ratings of a motor.
/// @param train  drive train of the joint; its rotor inertia is replaced by that of the motor
/// @param loads  loads of the joint at equidistant times, at least one
MotorFit fit(const Motor& motor, DriveTrain train, std::span<const JointLoad> loads);

}  // namespace pkm
