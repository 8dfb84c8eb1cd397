// The entries of the catalogue of optimisers: one line per entry here and one in all.cpp.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry genetic_algorithm();
OptimiserEntry nsga2();
OptimiserEntry sweep();
OptimiserEntry nlopt_stage();
OptimiserEntry ipopt_stage();

}  // namespace pkm
