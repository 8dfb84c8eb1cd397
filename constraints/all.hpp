// The catalogue of constraints.
#pragma once

#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// Every constraint there is, in the order in which `pkmopt list` shows them.
const std::vector<ConstraintEntry>& all_constraints();

}  // namespace pkm
