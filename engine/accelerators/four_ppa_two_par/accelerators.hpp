// 4PPa-2PaR: accelerators for the generic engine, for the mode lower,lower with x, z and theta swept.
#pragma once

#include "engine/mechanism/accelerators.hpp"

namespace pkm::four_ppa_two_par {

Accelerators accelerators();

}  // namespace pkm::four_ppa_two_par
