// A drive train between a motor and a joint: a gear, a screw or both, what turns with the motor, and losses.
//
//   w = g qdot                    speed of the motor; g = gear of a turning joint, gear 2 pi / lead of a screw [rad/m]
//   f = tau + F_c n + b qdot      what the train's far end gives: the joint's force tau, Coulomb and viscous friction
//   T = J g qddot + (f (1/eta + eta) + |f| n (1/eta - eta)) / (2 g)          torque of the motor
//   n = qdot / sqrt(qdot^2 + v_0^2)                                          direction of the joint's motion
//
// At speeds well above v_0 the motor drives with f / eta and brakes with f eta. Below, friction and the losses of the
// transmission go to 0 with the speed, smoothly: at rest nothing sticks.
#pragma once

#include <string>
#include <vector>

#include "engine/math/scalar.hpp"
#include "engine/math/small_matrix.hpp"

namespace pkm {

struct DriveTrain {
  double ratio = 1;  ///< g: speed of the motor per speed of the joint [1 or rad/m]
  double rotor = 0;  ///< inertia of the motor's rotor [kg m^2]
  double shaft = 0;  ///< of all else that turns with it: screw, coupling, gear [kg m^2]
  double efficiency = 1;
  double coulomb = 0;  ///< at the joint [N, N m]
  double viscous = 0;  ///< [N s/m, N m s/rad]
  double slow = 1e-3;  ///< v_0 [m/s, rad/s]

  /// What the joint feels of J [kg, kg m^2].
  double reflected() const { return (rotor + shaft) * ratio * ratio; }
  template <class S>
  S direction(const S& speed) const {
    return speed / sqrt(S(speed * speed + slow * slow));
  }
  /// Against the joint's motion [N, N m].
  template <class S>
  S friction(const S& speed) const {
    return direction(speed) * coulomb + speed * viscous;
  }
  /// Torque of the motor [N m]. @param force  of the joint, without friction and without reflected()
  template <class S>
  S torque(const S& force, const S& speed, const S& acceleration) const {
    const S far = force + friction(speed);
    const double mean = 0.5 * (1 / efficiency + efficiency), half = 0.5 * (1 / efficiency - efficiency);
    return acceleration * ((rotor + shaft) * ratio) + (far * mean + magnitude(far) * direction(speed) * half) / ratio;
  }
};

/// By joint.
using DriveTrains = std::vector<DriveTrain>;

/// What the trains add to the diagonal of M_q.
inline std::vector<double> reflected(const DriveTrains& trains) {
  std::vector<double> all;
  for (const DriveTrain& train : trains) all.push_back(train.reflected());
  return all;
}

}  // namespace pkm
