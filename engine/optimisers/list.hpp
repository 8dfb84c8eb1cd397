// Functions that return the catalogue entries of the optimisers. Each entry has one line here and one in all.cpp.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry genetic_algorithm();
OptimiserEntry nsga2();
OptimiserEntry sweep();
OptimiserEntry nlopt_stage();
OptimiserEntry ipopt_stage();

}  // namespace pkm
