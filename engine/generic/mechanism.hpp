// A mechanism from its description.
#pragma once

#include <memory>

#include "engine/generic/model.hpp"
#include "engine/mechanism/accelerators.hpp"

namespace pkm::generic {

/// @param accelerators  closed forms of this mechanism
std::shared_ptr<const Mechanism> make_mechanism(Model model, Accelerators accelerators = {});

}  // namespace pkm::generic
