// Whether a design describes a mechanism: ranges of joints that are not empty, and the tests that a file requires.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Empty where the design describes a mechanism; else the first empty range of a joint or violated requirement.
Unsupported refuse_design(const Evaluation& evaluation, std::span<const double> parameters);

}  // namespace pkm::generic
