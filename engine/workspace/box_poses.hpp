// Regular grid of the poses in the box of a workspace plan.
#pragma once

#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Number of grid points along each edge of a box in which a task is tested, unless a study sets another.
inline constexpr int kBoxPoints = 5;

/// The poses of a regular grid of the plan's box, including its faces and vertices, at every value of the fixed
/// coordinates. Throws std::invalid_argument if the plan has no box, or a fixed coordinate has no number.
/// @param points  number of grid points along each edge, at least 2
/// @param where   name of the region with an article, for messages: "region 'bin'"
std::vector<Pose<double>> poses_of_box(const WorkspacePlan& plan, const MechanismInfo& info, int points,
                                       const std::string& where);

}  // namespace pkm
