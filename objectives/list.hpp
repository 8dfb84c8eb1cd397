// The entries of the catalogue of objectives: one line per entry here and one in all.cpp.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

ObjectiveEntry workspace_volume();
ObjectiveEntry workspace_ratio();
std::vector<ObjectiveEntry> pose_objectives();  ///< of every quantity of poses
std::vector<ObjectiveEntry> peak_objectives();  ///< of forces and power along a motion
ObjectiveEntry expression_objective();

}  // namespace pkm
