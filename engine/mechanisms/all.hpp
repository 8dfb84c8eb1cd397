// The catalogue of mechanisms.
#pragma once

#include <memory>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

using MechanismList = std::vector<std::shared_ptr<const Mechanism>>;

/// Every mechanism there is, in the order in which `pkmopt list` shows them.
const MechanismList& all_mechanisms();

}  // namespace pkm
