// Which motors of a table do a motion.
#pragma once

#include <string>

#include "engine/mechanism/trajectory.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Prints which motors do the motion at every joint, their reserve, and whether the mechanism keeps its limits along
/// the motion.
/// @param file  with the table of motors
void tell_motors(const Target& target, const std::string& mode, const Trajectory& trajectory, const std::string& file,
                 Printout& out);

}  // namespace pkm
