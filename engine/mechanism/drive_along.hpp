// What the actuators of a design do along a motion: for double and for the derivative scalar.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// One sample of a motion: qdot = J Xdot, qddot = J Xddot + Jdot Xdot, tau by virtual work.
template <class S>
struct Drive {
  AxisVector<S> joints, speeds, accelerations;  ///< q [m, rad], qdot, qddot
  AxisVector<S> forces;                         ///< tau [N, N m]; NaN where J is singular to working precision

  S power(std::size_t joint) const { return forces[joint] * speeds[joint]; }  ///< > 0: the actuator drives [W]
  /// Torque of the joint's motor [N m]. @param train  whose reflected inertia is in the forces
  S torque(const DriveTrain& train, std::size_t joint) const {
    const S bare = forces[joint] - accelerations[joint] * train.reflected();
    return train.torque(bare, speeds[joint], accelerations[joint]);
  }
};

/// Room for the states that the mechanism is asked for at once.
template <class S>
struct DriveScratch {
  std::vector<MotionState<S>> states;
  std::vector<PoseDynamics<S>> dynamics;
};

/// So many samples the mechanism is asked for at once.
inline constexpr std::size_t kDriveBatch = 32;

/// Calls visit(k, Drive<S>) for the samples in order, as far as the mechanism assembles.
/// @param parameters  all parameters of the design
/// @param mode        one of MechanismInfo::modes
/// @param wrench      on the platform, the same all the time
/// @return            the first sample at which the mechanism does not assemble; samples.size() when there is none
template <class S, class Visit>
std::size_t drive_along(const Dynamics& mechanism, std::span<const S> parameters, const std::string& mode,
                        std::span<const MotionSample> samples, const Wrench<double>& wrench, DriveScratch<S>& scratch,
                        const Visit& visit) {
  scratch.states.resize(kDriveBatch);
  scratch.dynamics.resize(kDriveBatch);
  Wrench<S> load;
  for (std::size_t i = 0; i < 6; ++i) load[i] = S(wrench[i]);
  for (std::size_t first = 0; first < samples.size(); first += kDriveBatch) {
    const std::size_t count = std::min(kDriveBatch, samples.size() - first);
    const std::span<MotionState<S>> states(scratch.states.data(), count);
    const std::span<PoseDynamics<S>> dynamics(scratch.dynamics.data(), count);
    for (std::size_t k = 0; k < count; ++k) states[k] = {samples[first + k].pose, samples[first + k].velocity};
    mechanism.equations(parameters, mode, states, dynamics);
    for (std::size_t k = 0; k < count; ++k) {
      const PoseDynamics<S>& d = dynamics[k];
      if (!d.assembles) return first + k;
      const AxisVector<S>& acceleration = samples[first + k].acceleration;
      visit(first + k, Drive<S>{d.q, d.J * states[k].velocity, d.J * acceleration + d.J_rate_X,
                                drive_forces(d, acceleration, load)});
    }
  }
  return samples.size();
}

}  // namespace pkm
