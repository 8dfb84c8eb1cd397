// Factories of the entries of the catalogue of objectives. A new entry needs one line here and one in all.cpp.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

ObjectiveEntry workspace_volume();
ObjectiveEntry workspace_ratio();
ObjectiveEntry orientation_workspace();                  ///< orientations that are feasible at a point
std::vector<ObjectiveEntry> pose_objectives();           ///< statistics of the built-in pose quantities
ObjectiveEntry quantity_objective();                     ///< any statistic of any pose quantity
std::vector<ObjectiveEntry> peak_objectives();           ///< maximum forces, power, speeds, .. along a motion
std::vector<ObjectiveEntry> size_objectives();           ///< mass, and box of the links
std::vector<ObjectiveEntry> largest_solid_objectives();  ///< largest box, cylinder and sphere in the workspace
ObjectiveEntry energy();                                 ///< energy of the drives over a motion
ObjectiveEntry yield_objective();                        ///< share of built machines that satisfy all constraints
ObjectiveEntry cycle_time();                             ///< shortest time of a motion within limits
ObjectiveEntry expression_objective();
ObjectiveEntry python_objective();

}  // namespace pkm
