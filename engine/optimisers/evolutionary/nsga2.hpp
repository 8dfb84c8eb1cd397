// The catalogue's entry `nsga2`.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm {

OptimiserEntry nsga2();

}  // namespace pkm
