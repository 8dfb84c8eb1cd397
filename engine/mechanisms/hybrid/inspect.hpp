// Hybrid robot: the report on one pose.
#pragma once

#include "engine/mechanisms/hybrid/limits.hpp"

namespace pkm::hybrid {

/// The margin of obstacles.
inline constexpr const char* kObstacleMargin = "cap_obstacle";

/// @param branch  required sign of N2, +1 or -1
PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Obstacles& obstacles,
                   const Pose<double>& pose, const WorkingMode& mode, int branch);

}  // namespace pkm::hybrid
