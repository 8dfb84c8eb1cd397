// What the actuators of a design do along a motion: for double and for the derivative scalar.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// One sample of a motion.
template <class S>
struct Drive {
  Vector<S, 4> joints, speeds, accelerations;  ///< q [m], qdot [m/s], qddot [m/s^2]
  Vector<S, 4> forces;                         ///< tau [N]

  S power(std::size_t joint) const { return forces[joint] * speeds[joint]; }  ///< > 0: the actuator drives [W]
};

/// qdot = J Xdot, qddot = J Xddot + Jdot Xdot, tau by virtual work.
template <class S>
Drive<S> drive_of(const PoseDynamics<S>& d, const Vector<S, 4>& velocity, const Vector<S, 4>& acceleration,
                  const Wrench<S>& wrench) {
  return {d.q, d.J * velocity, d.J * acceleration + d.J_rate_X, drive_forces(d, acceleration, wrench)};
}

template <class S>
Vector<S, 4> as_scalar(const Vector<double, 4>& x) {
  return {{S(x[0]), S(x[1]), S(x[2]), S(x[3])}};
}

/// Calls visit(k, Drive<S>) for the samples in order, as far as the mechanism assembles.
/// @param parameters  all parameters of the design
/// @param mode        one of MechanismInfo::modes
/// @param wrench      on the platform, the same all the time
/// @return            the first sample at which the mechanism does not assemble; samples.size() when there is none
template <class S, class Visit>
std::size_t drive_along(const Mechanism& mechanism, std::span<const S> parameters, const std::string& mode,
                        std::span<const MotionSample> samples, const Wrench<double>& wrench, const Visit& visit) {
  constexpr std::size_t kBatch = 32;  // states that the mechanism is asked for at once
  thread_local std::vector<MotionState<S>> states(kBatch);
  thread_local std::vector<PoseDynamics<S>> dynamics(kBatch);
  Wrench<S> load;
  for (std::size_t i = 0; i < 6; ++i) load[i] = S(wrench[i]);
  for (std::size_t first = 0; first < samples.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, samples.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const MotionSample& at = samples[first + k];
      states[k] = {{S(at.pose[0]), S(at.pose[1]), S(at.pose[2]), S(at.pose[3])}, as_scalar<S>(at.velocity)};
    }
    mechanism.dynamics(parameters, mode, std::span<const MotionState<S>>(states.data(), count),
                       std::span<PoseDynamics<S>>(dynamics.data(), count));
    for (std::size_t k = 0; k < count; ++k) {
      if (!dynamics[k].assembles) return first + k;
      visit(first + k, drive_of(dynamics[k], states[k].velocity, as_scalar<S>(samples[first + k].acceleration), load));
    }
  }
  return samples.size();
}

}  // namespace pkm
