// Simulation (forward dynamics over time): motion of the platform under given actuator forces, gravity and a wrench.
//
// The equations of motion are integrated by the three-stage Gauss method, an implicit Runge-Kutta method of order 6. It
// is symmetric (integrating backwards in time returns to the initial state), so the energy does not drift as it does
// with explicit methods. The work of the actuators, of friction, of gravity and of the wrench is integrated by the same
// quadrature. The difference between the change in kinetic energy and the sum of these works measures the integration
// error; the simulation stops with a message if it exceeds the tolerance.
//
// Reference: Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", section II.7, table 7.4.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"

namespace pkm {

/// State of a simulation at one time. Vectors have one element per coordinate.
struct SimulationState {
  double time = 0;  ///< time since the start [s]
  AxisVector<double> pose, velocity, acceleration;
  double kinetic_energy = 0;  ///< kinetic energy of the mechanism at `time` [J]
  /// Work done since the start by the drives, the weight and the wrench [J].
  double work_of_drives = 0, work_of_weight = 0, work_of_wrench = 0;
  double work_of_friction = 0;  ///< work done by friction since the start, <= 0 [J]
};

struct SimulationSetup {
  /// Evaluates the equations of motion of the mechanism at a pose and velocity.
  std::function<PoseDynamics<double>(const MotionState<double>&)> dynamics;
  std::function<AxisVector<double>(double time)> forces;  ///< actuator forces tau as a function of the time [N, N m]
  /// Friction forces as a function of the joint speeds; positive values oppose positive speeds [N, N m]. Empty: no
  /// friction.
  std::function<AxisVector<double>(const AxisVector<double>& speeds)> friction;
  Wrench<double> wrench;  ///< constant load on the platform [N, N m]
  /// Returns the reason why the simulation must stop at a pose, for example a violated limit, as a sentence; otherwise
  /// "". An empty function: poses are not checked.
  std::function<std::string(const Pose<double>&)> refuse;
  double duration = 0;      ///< duration of the simulation, > 0 [s]
  double step = 0;          ///< time step, > 0 [s]; the last step is shortened so that it ends at `duration`
  double tolerance = 1e-9;  ///< maximum energy error, relative to Simulation::turned_over
};

struct Simulation {
  std::vector<SimulationState> states;  ///< the initial state and the state after every step
  std::string stopped;                  ///< the reason if the simulation stopped early, one sentence; "" if it did not
  double imbalance = 0;    ///< maximum difference between the change of the kinetic energy and the work done [J]
  double turned_over = 0;  ///< initial kinetic energy plus the sum of |work| of all steps [J]
};

/// Simulates a motion from an initial pose and velocity.
Simulation simulate(const SimulationSetup& setup, const AxisVector<double>& pose, const AxisVector<double>& velocity);

}  // namespace pkm
