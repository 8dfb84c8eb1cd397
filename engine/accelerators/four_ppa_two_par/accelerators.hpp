// 4PPa-2PaR: closed forms in place of the generic engine. They are of the lower mode, over x, z and theta.
#pragma once

#include "engine/mechanism/accelerators.hpp"

namespace pkm::four_ppa_two_par {

Accelerators accelerators();

}  // namespace pkm::four_ppa_two_par
