// Factories of the entries of the catalogue of constraints. A new entry needs one line here and one in all.cpp.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

ConstraintEntry interference();
ConstraintEntry singularity_margin();
ConstraintEntry clearance();
ConstraintEntry workspace_shape();
ConstraintEntry rail_length();
ConstraintEntry task_workspace();
ConstraintEntry motion_constraint();
ConstraintEntry linear();
ConstraintEntry expression_constraint();

}  // namespace pkm
