// The catalogue of objectives.
#pragma once

#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// All objectives, in the order in which `pkmopt list` prints them.
const std::vector<ObjectiveEntry>& all_objectives();

}  // namespace pkm
