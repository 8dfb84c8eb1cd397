// Margins of poses, as numbers or with derivatives by the parameters: for constraints on regions and motions.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Appends the finite margins of each pose: domains, margins and clearance, each in its own unit. A pose with a margin
/// that is not finite, or without a solution for a joint, is infeasible; if none of its margins is negative, -1 is
/// appended.
template <class S>
void append_margins(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                    const LimitSpec& limits, std::span<const Pose<double>> poses, Scratch& scratch,
                    std::vector<S>& margins);

}  // namespace pkm::generic
