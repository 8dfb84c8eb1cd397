// Inverse kinematics and inverse dynamics of a mechanism along a motion: joints, limits, conditioning and, with masses,
// forces and power.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// One sample of a trajectory. Values that do not exist (because the mechanism cannot be assembled at the pose, or has
/// no masses) are std::nullopt. If J is singular to working precision (engine/geometry/singular.hpp), no forces produce
/// the motion: the sample is infeasible and has no forces. With redundant drives the forces are not unique: the sample
/// has joint speeds, but no forces.
struct TrajectoryPoint {
  MotionSample motion;
  bool feasible = false;
  std::string reason;  ///< the reason if the sample is infeasible; "" if it is feasible
  std::optional<double> conditioning;
  /// Position q [m, rad], velocity and acceleration of each joint.
  std::optional<AxisVector<double>> joints, speeds, accelerations;
  /// Force or torque tau of each joint [N, N m], and its power tau qdot [W], > 0 if the actuator drives.
  std::optional<AxisVector<double>> forces, power;
  /// Torque [N m] and speed [rad/s] of each motor, if there are drive trains.
  std::optional<AxisVector<double>> torques, motor_speeds;
  std::vector<double> quantities;      ///< values of MechanismInfo::quantities; NaN: undefined
  std::optional<Reactions> reactions;  ///< reactions in the joints, set by add_reactions()
};

/// Statistics over the samples of a trajectory; each is taken over those samples at which its value exists. Vectors
/// have one element per joint.
struct TrajectorySummary {
  std::size_t infeasible = 0;                    ///< number of samples that are infeasible
  std::optional<AxisVector<double>> peak_speed;  ///< maximum |qdot| [m/s, rad/s]; std::nullopt if no sample has speeds
  bool has_forces = false;  ///< true if every sample has forces; otherwise all members from `peak_force` on are 0
  /// Maximum |tau| and root-mean-square tau of each joint over the samples [N, N m].
  AxisVector<double> peak_force, rms_force;
  AxisVector<double> peak_power;  ///< maximum |tau qdot|, driving or braking [W]
  /// Torques [N m] and speed [rad/s] of the motors of drive trains.
  AxisVector<double> peak_torque, rms_torque, peak_motor_speed;
  double peak_total_power = 0, min_total_power = 0;  ///< maximum and minimum of the sum of the powers of all joints [W]
  /// Time integrals by the trapezoidal rule [J]: of the total power (energy with full regeneration), and of the
  /// positive parts of the joints' powers (energy without regeneration).
  double energy = 0, energy_drawn = 0;
};

struct Trajectory {
  double duration = 0;
  bool periodic = false;  ///< true if the motion can be repeated (is_periodic()); energies are then per cycle
  std::vector<TrajectoryPoint> points;
  TrajectorySummary summary;
};

/// Computes `count` >= 2 samples at equidistant times, including the start and the end of the motion. Joint speeds and
/// accelerations require dynamics or influence coefficients; they are not approximated by finite differences. Throws
/// DesignError if a mass is not positive.
/// @param parameters  all parameters of the design
/// @param mode        one of MechanismInfo::modes
/// @param wrench      constant load on the platform [N, N m]
Trajectory compute_trajectory(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                              const LimitSpec& limits, const Motion& motion, std::size_t count,
                              const Wrench<double>& wrench = {});

/// Names and values of all quantities except those that depend on the design alone.
/// @param values  values of MechanismInfo::quantities; may be empty
NamedValues pose_quantities_of(const MechanismInfo& info, const std::vector<double>& values);

/// Names and values of the inputs, their rates and their accelerations, followed by the quantities; undefined values
/// are NaN.
NamedValues input_and_quantity_values(const MechanismInfo& info, const TrajectoryPoint& point);

}  // namespace pkm
