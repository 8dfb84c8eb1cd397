// The catalogue of objectives.
#pragma once

#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// Every objective there is, in the order in which `pkmopt list` shows them.
const std::vector<ObjectiveEntry>& all_objectives();

}  // namespace pkm
