// A mechanism from its description.
#pragma once

#include <memory>

#include "engine/mechanisms/described/model.hpp"

namespace pkm::described {

std::shared_ptr<const Mechanism> make_mechanism(Model model);

}  // namespace pkm::described
