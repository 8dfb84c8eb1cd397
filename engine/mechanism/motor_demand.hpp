// Demand of a trajectory on the motors of a mechanism with drive trains, for the choice of motors.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/motor.hpp"
#include "engine/mechanism/trajectory.hpp"

namespace pkm {

/// The load of each joint at each sample: speed, acceleration, and the force without the contribution of the inertia of
/// the joint's present motor.
/// @return one vector per joint, with one element per sample
/// @param trajectory  a trajectory with forces at all samples
std::vector<std::vector<JointLoad>> joint_loads(const DriveTrains& trains, const Trajectory& trajectory);

/// Mean, over the samples of a trajectory, of the largest dynamic coupling index among the joints, if every joint is
/// driven by the given motor.
/// @param mechanism  must have dynamics and drive trains
/// @param mode       one of MechanismInfo::modes
double mean_coupling_index(const Motor& motor, const Mechanism& mechanism, std::span<const double> parameters,
                           const std::string& mode, const Trajectory& trajectory);

}  // namespace pkm
