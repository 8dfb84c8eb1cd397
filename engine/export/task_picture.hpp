// Picture of a comparison of robots in a task: slices of the workspaces with the regions, and the loads over time.
#pragma once

#include "engine/export/picture.hpp"
#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Draws the comparison. The workspaces of all robots are outlined on common axes, in slices through
/// TaskComparison::middle; a robot that lacks one of the axes of a slice is omitted there. Below, each load along a
/// motion is drawn over time with one curve for each robot. Each robot has one colour.
Picture draw_comparison(const TaskComparison& comparison);

}  // namespace pkm
