// A mechanism that follows a motion: joints, limits, conditioning and, with masses, forces and power.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// One sample. What does not exist (the pose does not assemble, no masses) is absent. Where J is singular to working
/// precision (engine/geometry/singular.hpp) no forces give the motion: the sample is not feasible and has none.
/// Redundant drives have no unique forces: their samples have speeds alone, by the same rule.
struct TrajectoryPoint {
  MotionSample motion;
  bool feasible = false;
  std::string reason;  ///< why it is not; "" when feasible
  std::optional<double> conditioning;
  std::optional<AxisVector<double>> joints, speeds, accelerations;  ///< q [m, rad], qdot, qddot
  std::optional<AxisVector<double>> forces, power;          ///< tau [N, N m], tau qdot [W]; > 0: the actuator drives
  std::optional<AxisVector<double>> torques, motor_speeds;  ///< of the motors, with drive trains [N m, rad/s]
  std::vector<double> quantities;                           ///< by MechanismInfo::quantities; NaN: undefined
  std::optional<Reactions> reactions;                       ///< in the joints, where add_reactions() has looked
};

/// Over the samples that have the numbers; the rest is told by `infeasible`.
struct TrajectorySummary {
  std::size_t infeasible = 0;
  std::optional<AxisVector<double>> peak_speed;  ///< greatest |qdot| [m/s, rad/s]; absent when no sample has any
  bool has_forces = false;                       ///< of every sample; the following are set
  AxisVector<double> peak_force, rms_force;      ///< greatest |tau|; root of the mean square over the samples [N]
  AxisVector<double> peak_power;                 ///< greatest |tau qdot|, driving or braking [W]
  AxisVector<double> peak_torque, rms_torque, peak_motor_speed;  ///< of the motors, with drive trains [N m, rad/s]
  double peak_total_power = 0, least_total_power = 0;            ///< of the sum over the joints [W]
  /// Integrals over the time, by the trapezoidal rule [J]: of the sum of tau qdot (what is left of it when braking
  /// gives back what it takes), and of each joint's tau qdot where it drives (when it gives back nothing).
  double energy = 0, energy_drawn = 0;
};

struct Trajectory {
  double duration = 0;
  bool periodic = false;  ///< the motion ends as it begins: energies are those of a cycle
  std::vector<TrajectoryPoint> points;
  TrajectorySummary summary;
};

/// Follows `count` samples, both ends included.
///
/// Speeds and accelerations of the joints are exact; a mechanism without dynamics and influence coefficients has none.
/// Throws DesignError where a mass is not positive.
/// @param parameters  all parameters of the design
/// @param mode        one of MechanismInfo::modes
/// @param wrench      on the platform, the same all the time
Trajectory follow(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                  const LimitSpec& limits, const Motion& motion, std::size_t count, const Wrench<double>& wrench = {});

}  // namespace pkm
