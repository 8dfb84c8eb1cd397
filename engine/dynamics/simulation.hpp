// Forward dynamics over time: the platform under given forces of the actuators, weight and a wrench.
//
// The equations of motion are integrated by Gauss' method of three stages (order 6, implicit, symmetric: run backwards
// it returns to where it began, so the energy does not drift as it does with explicit methods). Along with the state it
// adds up the work of the actuators, of friction, of the weight and of the wrench by the same rule. What the kinetic
// energy differs from their sum is the error of the integration: a run ends, with a sentence, where it exceeds the
// tolerance.
//
// Source of the method: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.7, table 7.4.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"

namespace pkm {

/// Vectors: one number per coordinate, and their rates.
struct SimulationState {
  double time = 0;
  AxisVector<double> pose, velocity, acceleration;
  double kinetic_energy = 0;                                          ///< [J]
  double work_of_drives = 0, work_of_weight = 0, work_of_wrench = 0;  ///< since the beginning [J]
  double work_of_friction = 0;                                        ///< <= 0
};

struct SimulationSetup {
  std::function<PoseDynamics<double>(const MotionState<double>&)> dynamics;
  std::function<AxisVector<double>(double time)> forces;  ///< tau [N] at a time [s]
  /// Forces against the joints' motion at their speeds [N, N m]; none: there is no friction.
  std::function<AxisVector<double>(const AxisVector<double>& speeds)> friction;
  Wrench<double> wrench;  ///< on the platform, the same all the time
  /// "" or a sentence saying why a pose ends the run (a limit of the mechanism); none: nothing ends it.
  std::function<std::string(const Pose<double>&)> refuse;
  double duration = 0;      ///< [s], > 0
  double step = 0;          ///< [s], > 0; the last step ends at the duration
  double tolerance = 1e-9;  ///< of the energy that has been turned over
};

struct Simulation {
  std::vector<SimulationState> states;  ///< the beginning and the end of every step that was made
  std::string stopped;                  ///< why it ended before the duration; "" otherwise
  double imbalance = 0;                 ///< greatest difference of kinetic energy and work [J]
  double turned_over = 0;               ///< kinetic energy at the beginning and magnitudes of all works [J]
};

Simulation simulate(const SimulationSetup& setup, const AxisVector<double>& pose, const AxisVector<double>& velocity);

}  // namespace pkm
