// Ipopt as a stage.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry ipopt_stage();

}  // namespace pkm
