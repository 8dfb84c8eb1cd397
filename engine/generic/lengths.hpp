// The characteristic lengths of a design: of the platform's rotations, and of rotary drives beside linear ones.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Throws DesignError with a sentence where one that the conditioning needs is not a positive number.
void check_lengths(const Evaluation& evaluation, std::span<const double> parameters);

}  // namespace pkm::generic
