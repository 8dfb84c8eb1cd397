// The catalogue of mechanisms.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Every mechanism there is, in the order in which `pkmopt list` shows them.
const MechanismList& all_mechanisms();

}  // namespace pkm
