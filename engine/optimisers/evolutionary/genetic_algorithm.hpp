// The genetic algorithm for one objective with constraints.
//
// Each generation: parents are selected by rank, children are bred (breeding.hpp), the new ones are evaluated as one
// batch, and the survivors form the next population: either the best of parents and children together (`best`), or
// the children and the `elite` best parents (`generational`). Designs are ranked by the feasibility rules (order.hpp).
// Nothing depends on the number of generations, so a finished run can be extended.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry genetic_algorithm();

}  // namespace pkm
