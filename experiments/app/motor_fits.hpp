// Which motors of a table do a motion.
#pragma once

#include <string>
#include <vector>

#include "engine/dynamics/motor.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Prints which motors do the motion at every joint, their reserve, and whether the mechanism keeps its limits along
/// the motion.
void tell_motors(const Target& target, const std::string& mode, const Trajectory& trajectory,
                 const std::vector<Motor>& motors, Printout& out);

}  // namespace pkm
