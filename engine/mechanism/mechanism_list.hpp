// Mechanisms to choose from, by name.
#pragma once

#include <memory>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

using MechanismList = std::vector<std::shared_ptr<const Mechanism>>;

}  // namespace pkm
