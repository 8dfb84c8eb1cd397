// NLopt's algorithms as a stage.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry nlopt_stage();

}  // namespace pkm
