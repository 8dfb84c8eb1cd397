// Hybrid robot: accelerators for the generic engine, for any one working mode with x, z and beta swept.
#pragma once

#include "engine/mechanism/accelerators.hpp"

namespace pkm::hybrid {

Accelerators accelerators();

}  // namespace pkm::hybrid
