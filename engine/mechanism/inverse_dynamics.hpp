// Inverse dynamics along a motion: state and force of every actuator, for double and for the derivative scalar.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/design_motion.hpp"

namespace pkm {

/// State of all actuators at one sample of a motion: qdot = J Xdot, qddot = J Xddot + Jdot Xdot, and forces by virtual
/// work.
template <class S>
struct ActuatorState {
  AxisVector<S> joints, speeds, accelerations;  ///< q [m, rad] and its first and second time derivatives
  AxisVector<S> forces;  ///< force or torque tau of each actuator [N, N m]; NaN if J is singular to working precision

  /// Power of the actuator of a joint [W]; > 0 if it drives, < 0 if it brakes.
  S power(std::size_t joint) const { return forces[joint] * speeds[joint]; }
  /// Torque of the joint's motor [N m].
  /// @param train  drive train of the joint, whose reflected inertia is included in `forces`
  S torque(const DriveTrain& train, std::size_t joint) const {
    const S bare = forces[joint] - accelerations[joint] * train.reflected();
    return train.torque(bare, speeds[joint], accelerations[joint]);
  }
};

/// Scratch memory for the computation of one batch of samples.
template <class S>
struct InverseDynamicsScratch {
  std::vector<MotionState<S>> states;
  std::vector<PoseDynamics<S>> dynamics;
};

/// Maximum number of samples that one call of Dynamics::equations() evaluates.
inline constexpr std::size_t kInverseDynamicsBatch = 32;

/// The equations of motion at samples in batches: calls visit(k, MotionState<S>, PoseDynamics<S>) for the samples in
/// order, up to the first that cannot be assembled or for which `visit` returns false.
/// @param samples     MotionSample, or DualMotionSample with S = Dual4
/// @return            index of the first sample that cannot be assembled or for which `visit` returned false;
///   samples.size() if there is none
template <class S, class Sample, class Visit>
std::size_t equations_along(const Dynamics& mechanism, std::span<const S> parameters, const std::string& mode,
                            std::span<const Sample> samples, InverseDynamicsScratch<S>& scratch, const Visit& visit) {
  scratch.states.resize(kInverseDynamicsBatch);
  scratch.dynamics.resize(kInverseDynamicsBatch);
  for (std::size_t first = 0; first < samples.size(); first += kInverseDynamicsBatch) {
    const std::size_t count = std::min(kInverseDynamicsBatch, samples.size() - first);
    const std::span<MotionState<S>> states(scratch.states.data(), count);
    const std::span<PoseDynamics<S>> dynamics(scratch.dynamics.data(), count);
    for (std::size_t k = 0; k < count; ++k) states[k] = {samples[first + k].pose, samples[first + k].velocity};
    mechanism.equations(parameters, mode, states, dynamics);
    for (std::size_t k = 0; k < count; ++k)
      if (!dynamics[k].assembles || !visit(first + k, states[k], dynamics[k])) return first + k;
  }
  return samples.size();
}

/// Calls visit(k, ActuatorState<S>) for the samples in order, up to the first that cannot be assembled.
/// @param parameters  all parameters of the design
/// @param mode        one of MechanismInfo::modes
/// @param wrench      constant load on the platform [N, N m]
/// @return            index of the first sample that cannot be assembled; samples.size() if there is none
template <class S, class Sample, class Visit>
std::size_t inverse_dynamics_of(const Dynamics& mechanism, std::span<const S> parameters, const std::string& mode,
                                std::span<const Sample> samples, const Wrench<double>& wrench,
                                InverseDynamicsScratch<S>& scratch, const Visit& visit) {
  Wrench<S> load;
  for (std::size_t i = 0; i < 6; ++i) load[i] = S(wrench[i]);
  return equations_along<S>(mechanism, parameters, mode, samples, scratch,
                            [&](std::size_t k, const MotionState<S>& state, const PoseDynamics<S>& d) {
                              const AxisVector<S>& acceleration = samples[k].acceleration;
                              visit(k, ActuatorState<S>{d.q, d.J * state.velocity, d.J * acceleration + d.J_rate_X,
                                                        drive_forces(d, acceleration, load)});
                              return true;
                            });
}
template <class S, class Visit>
std::size_t inverse_dynamics_along(const Dynamics& mechanism, std::span<const S> parameters, const std::string& mode,
                                   std::span<const MotionSample> samples, const Wrench<double>& wrench,
                                   InverseDynamicsScratch<S>& scratch, const Visit& visit) {
  return inverse_dynamics_of<S>(mechanism, parameters, mode, samples, wrench, scratch, visit);
}

}  // namespace pkm
