// The generic engine: a Mechanism that evaluates the formulas of a mechanism file.
#pragma once

#include <memory>

#include "engine/generic/model.hpp"
#include "engine/mechanism/accelerators.hpp"

namespace pkm::generic {

/// @param accelerators  closed forms for this mechanism; where they exist, they replace the generic evaluation
std::shared_ptr<const Mechanism> make_mechanism(Model model, Accelerators accelerators = {});

struct Evaluation;
/// The evaluation of a mechanism from a file, whether or not it has drive trains; null for any other mechanism.
const Evaluation* evaluation_of(const Mechanism& mechanism);

}  // namespace pkm::generic
