// (3CRR/R)&CRU and Quadrupteron: accelerators for the generic engine.
#pragma once

#include <string>

#include "engine/accelerators/crr_cru/model.hpp"
#include "engine/mechanism/accelerators.hpp"

namespace pkm::crr_cru {

/// @param mass_model  "table" or "geometry"; it determines which parameters follow the lengths in a design
Accelerators accelerators(Platform platform, const std::string& mass_model);

}  // namespace pkm::crr_cru
