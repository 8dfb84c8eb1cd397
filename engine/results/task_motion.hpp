// Values of a robot along a motion of a task: speeds, forces, power, and the reserve of the drives.
#pragma once

#include <vector>

#include "engine/config/task.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Lines of the comparison, in the same order for every robot.
/// @param motion         name of the motion
/// @param found          the robot along the motion; without points: all values are undefined
/// @param needs_drives   true if the task has drive trains
/// @param why_no_drives  why the robot cannot have them
std::vector<TaskValue> values_along(const std::string& motion, const Mechanism& mechanism, const Trajectory& found,
                                    bool needs_drives, const Unsupported& why_no_drives);

/// Why the robot cannot be assembled, or is singular, at a sample of the motion; "" if there is no such sample.
std::string why_impossible(const Trajectory& found);

/// Power, and the largest speeds and forces among the prismatic and among the revolute drives, over time.
std::vector<TaskCurve> curves_along(const Mechanism& mechanism, const Trajectory& found);

}  // namespace pkm
