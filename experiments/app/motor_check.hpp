// Checks which motors of a table can perform a motion.
#pragma once

#include <string>
#include <vector>

#include "engine/dynamics/motor.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Reports for each motor of the table, when it is mounted at every joint: the minimum reserve (capacity / demand), the
/// joint and the rating that limit it, the mean coupling index, and whether all samples of the motion are feasible. A
/// motor is sufficient if its reserve is at least 1.
/// @param trajectory  must have forces at all samples; the mechanism must have drive trains
void report_motor_check(const Target& target, const std::string& mode, const Trajectory& trajectory,
                        const std::vector<Motor>& motors, Printout& out);

}  // namespace pkm
