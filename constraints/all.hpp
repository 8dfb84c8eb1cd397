// The catalogue of constraints.
#pragma once

#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// All constraints, in the order in which `pkmopt list` prints them.
const std::vector<ConstraintEntry>& all_constraints();

}  // namespace pkm
