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

/// One sample. Values that do not exist (because the mechanism cannot be assembled at the pose, or has no masses) are
/// empty. If J is singular to working precision (engine/geometry/singular.hpp), no forces produce the motion: the
/// sample is infeasible and has no forces. With redundant drives the forces are not unique: the sample has joint
/// speeds, but no forces.
struct TrajectoryPoint {
  MotionSample motion;
  bool feasible = false;
  std::string reason;  ///< why it is infeasible; "" if feasible
  std::optional<double> conditioning;
  std::optional<AxisVector<double>> joints, speeds, accelerations;  ///< q [m, rad], qdot, qddot
  std::optional<AxisVector<double>> forces, power;          ///< tau [N, N m], tau qdot [W]; > 0: the actuator drives
  std::optional<AxisVector<double>> torques, motor_speeds;  ///< of the motors, if there are drive trains [N m, rad/s]
  std::vector<double> quantities;                           ///< values of MechanismInfo::quantities; NaN: undefined
  std::optional<Reactions> reactions;                       ///< reactions in the joints, set by add_reactions()
};

/// Statistics for each joint, over all samples at which the value exists.
struct TrajectorySummary {
  std::size_t infeasible = 0;                    ///< number of infeasible samples
  std::optional<AxisVector<double>> peak_speed;  ///< maximum |qdot| [m/s, rad/s]; empty if no sample has speeds
  bool has_forces = false;                       ///< true if every sample has forces; otherwise the following are 0
  AxisVector<double> peak_force, rms_force;      ///< maximum |tau|; root of the mean square over the samples [N, N m]
  AxisVector<double> peak_power;                 ///< maximum |tau qdot|, driving or braking [W]
  AxisVector<double> peak_torque, rms_torque, peak_motor_speed;  ///< of the motors of drive trains [N m, rad/s]
  double peak_total_power = 0, min_total_power = 0;              ///< extrema of the sum over the joints [W]
  /// Time integrals by the trapezoidal rule [J]: of the total power (energy with full regeneration), and of the
  /// positive parts of the joints' powers (energy without regeneration).
  double energy = 0, energy_drawn = 0;
};

struct Trajectory {
  double duration = 0;
  bool periodic = false;  ///< is_periodic() holds, and the energies are those of one cycle
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

/// Names and values of the quantities of a pose and motion, i.e. of all quantities except those of the design alone.
/// @param values  values of MechanismInfo::quantities; may be empty
NamedValues pose_quantities_of(const MechanismInfo& info, const std::vector<double>& values);

/// Names and values of the inputs with their rates and accelerations, then of the quantities; undefined values are NaN.
NamedValues input_and_quantity_values(const MechanismInfo& info, const TrajectoryPoint& point);

}  // namespace pkm
