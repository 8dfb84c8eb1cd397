// The generic engine: a Mechanism that evaluates the formulas of a mechanism file.
#pragma once

#include <memory>

#include "engine/generic/model.hpp"
#include "engine/mechanism/accelerators.hpp"

namespace pkm::generic {

/// @param accelerators  closed forms for this mechanism, used in place of the generic evaluation where they exist
std::shared_ptr<const Mechanism> make_mechanism(Model model, Accelerators accelerators = {});

struct Evaluation;
/// The evaluation of a mechanism from a file, with or without drive trains; null for other mechanisms.
const Evaluation* evaluation_of(const Mechanism& mechanism);

}  // namespace pkm::generic
