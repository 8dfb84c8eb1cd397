// Margins of poses in numbers, and with derivatives by parameters.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Appends those of each pose, as inspect_pose lists them, each in its own unit: of a pose that does not assemble those
/// that have a value. A pose is infeasible where one has no finite value; where no other margin says so, it has -1.
template <class S>
void append_margins(const Evaluation& evaluation, std::span<const S> parameters, std::size_t mode,
                    const LimitSpec& limits, std::span<const Pose<double>> poses, Scratch& scratch,
                    std::vector<S>& margins);

}  // namespace pkm::generic
