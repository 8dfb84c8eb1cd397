// Model of a drive train between a motor and a joint: transmission (gear, screw or both), rotating inertia, friction
// and efficiency.
//
//   w = g qdot                    speed of the motor; g = gear for a revolute joint, gear 2 pi / lead for a screw
//   f = tau + F_c n + b qdot      output force: joint force tau, Coulomb friction and viscous friction
//   T = J g qddot + (f (1/eta + eta) + |f| n (1/eta - eta)) / (2 g)          torque of the motor
//   n = qdot / sqrt(qdot^2 + v_0^2)                                          smoothed sign of qdot
//
// At speeds well above v_0 the force at the motor is f / eta when driving and f eta when braking. Below v_0, friction
// and transmission losses decrease smoothly to 0 with the speed: the model has no stiction.
#pragma once

#include <string>
#include <vector>

#include "engine/math/scalar.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

struct DriveTrain {
  double ratio = 1;       ///< transmission ratio g: motor speed divided by joint speed [1 or rad/m]
  double rotor = 0;       ///< inertia of the motor's rotor [kg m^2]
  double shaft = 0;       ///< inertia of all other parts on the motor shaft: screw, coupling, gear [kg m^2]
  double efficiency = 1;  ///< efficiency eta of the transmission, in (0, 1]
  double coulomb = 0;     ///< Coulomb friction F_c at the joint [N, N m]
  double viscous = 0;     ///< coefficient b of the viscous friction at the joint [N s/m, N m s/rad]
  double slow = 1e-3;     ///< joint speed v_0 below which friction and losses decrease to 0 [m/s, rad/s]

  /// Inertia of rotor and shaft, reflected to the joint: J g^2 [kg, kg m^2].
  double reflected() const { return (rotor + shaft) * ratio * ratio; }
  /// The smoothed sign n of the joint speed, in (-1, 1).
  template <class S>
  S direction(const S& speed) const {
    return speed / sqrt(S(speed * speed + slow * slow));
  }
  /// Friction force at the joint, as a function of its speed [N, N m]. A positive value opposes a positive speed.
  template <class S>
  S friction(const S& speed) const {
    return direction(speed) * coulomb + speed * viscous;
  }
  /// Torque T of the motor [N m].
  /// @param force  tau: joint force without friction and without the reflected inertia
  template <class S>
  S torque(const S& force, const S& speed, const S& acceleration) const {
    const S load = force + friction(speed);
    const double mean = 0.5 * (1 / efficiency + efficiency), half = 0.5 * (1 / efficiency - efficiency);
    return acceleration * ((rotor + shaft) * ratio) + (load * mean + magnitude(load) * direction(speed) * half) / ratio;
  }
};

/// Drive train of each joint.
using DriveTrains = std::vector<DriveTrain>;

/// The reflected inertia of each drive train, which is added to the diagonal element of M_q.
inline std::vector<double> reflected(const DriveTrains& trains) {
  std::vector<double> all;
  for (const DriveTrain& train : trains) all.push_back(train.reflected());
  return all;
}

}  // namespace pkm
