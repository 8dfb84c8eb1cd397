// Values of a robot along a motion of a task: speeds, forces, power, and the reserve of the drives.
#pragma once

#include <vector>

#include "engine/config/task.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Values of a robot along a motion, as lines of the comparison; their order is the same for every robot.
/// @param motion         name of the motion
/// @param found          trajectory of the robot along the motion; if it has no points, all values are undefined
/// @param needs_drives   true if the task has drive trains
/// @param why_no_drives  reason why the robot cannot have these drive trains
std::vector<TaskValue> values_along(const std::string& motion, const Mechanism& mechanism, const Trajectory& found,
                                    bool needs_drives, const Unsupported& why_no_drives);

/// The reason why the robot cannot perform the motion: it cannot be assembled, or is singular, at a sample; "" if there
/// is no such sample.
std::string why_impossible(const Trajectory& found);

/// Power, and the largest speeds and forces among the prismatic and among the revolute drives, over time.
std::vector<TaskCurve> curves_along(const Mechanism& mechanism, const Trajectory& found);

}  // namespace pkm
