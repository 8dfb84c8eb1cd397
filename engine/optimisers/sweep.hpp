// Designs on a grid, evaluated one after the other without any search: how objectives depend on parameters.
//
// one-at-a-time: generation 0 is the centre (the first start design, else the middle of the space), generation i + 1
// moves variable i over its range and leaves the others at the centre. full-factorial: every combination, the last
// variable fastest, in generations of at most 1000 designs.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry sweep();

}  // namespace pkm
