// Hybrid robot: closed forms in place of the generic engine. They are over x, z and beta, of one working mode.
#pragma once

#include "engine/mechanism/accelerators.hpp"

namespace pkm::hybrid {

Accelerators accelerators();

}  // namespace pkm::hybrid
