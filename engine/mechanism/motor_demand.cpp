#include "engine/mechanism/motor_demand.hpp"

#include <algorithm>

#include "engine/dynamics/coupling.hpp"

namespace pkm {

std::vector<std::vector<JointLoad>> joint_loads(const DriveTrains& trains, const Trajectory& trajectory) {
  std::vector<std::vector<JointLoad>> loads(trains.size());
  for (const TrajectoryPoint& p : trajectory.points)
    for (std::size_t i = 0; i < trains.size(); ++i) {
      const double acceleration = (*p.accelerations)[i];
      loads[i].push_back({(*p.forces)[i] - trains[i].reflected() * acceleration, (*p.speeds)[i], acceleration});
    }
  return loads;
}

double mean_coupling_index(const Motor& motor, const Mechanism& mechanism, std::span<const double> parameters,
                           const std::string& mode, const Trajectory& trajectory) {
  double sum = 0;
  for (const TrajectoryPoint& p : trajectory.points) {
    const MotionState<double> state{p.motion.pose, p.motion.velocity};
    PoseDynamics<double> d;
    mechanism.dynamics()->equations(parameters, mode, {&state, 1}, {&d, 1});
    AxisMatrix<double> M_q = joint_inertia(d);
    for (std::size_t i = 0; i < M_q.rows(); ++i) {
      DriveTrain train = (*mechanism.drive_trains())[i];
      const double mounted = train.reflected();
      train.rotor = motor.rotor;
      M_q(i, i) += train.reflected() - mounted;
    }
    sum += std::ranges::max(coupling_indices(M_q));
  }
  return sum / static_cast<double>(trajectory.points.size());
}

}  // namespace pkm
