// Workspace of a robot in a comparison, and the reserve of a region in it.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Index of a coordinate of a mechanism; -1 if it has none of this name.
int coordinate_index(const MechanismInfo& info, const std::string& name);

/// The workspace over the axes of the comparison that the robot has; std::nullopt if no pose is feasible. Throws
/// std::invalid_argument if the mechanism does not support it.
/// @param cells  number of cells along each axis
std::optional<WorkspaceFields> workspace_over(const std::vector<AxisInfo>& axes, const TaskEvaluation& evaluation,
                                              const ComparedRobot& robot, std::int64_t cells);

/// Values of a robot's workspace (its size), as lines of the comparison.
/// @param counts  numbers of axes of the robots' workspaces; each gives one line: length (1), area (2) or volume (3)
std::vector<TaskValue> workspace_values(const std::vector<AxisInfo>& axes,
                                        const std::set<std::size_t, std::greater<>>& counts,
                                        const ComparedRobot& robot);

/// Name of the margin with the smallest value over several poses; "" if there are no margins.
std::string limiting_margin(const ComparedRobot& robot, const std::vector<Pose<double>>& poses);

/// The largest factor by which the box of a region can be scaled about its centre so that all poses of a grid remain
/// feasible.
/// @param poses  grid of poses in the box
TaskValue largest_scale(const Region& region, const ComparedRobot& robot, const std::vector<Pose<double>>& poses);

}  // namespace pkm
