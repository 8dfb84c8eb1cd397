// Checks whether a design describes a mechanism: no joint range is empty, and the required constraints are satisfied.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Empty if the design describes a mechanism; otherwise a message that names the first empty range or violated
/// constraint.
Unsupported refuse_design(const Evaluation& evaluation, std::span<const double> parameters);

}  // namespace pkm::generic
