// Determines the side of the singularities on which poses of a mechanism file lie. Constraints and Jacobian are
// evaluated in SIMD batches.
#pragma once

#include <memory>
#include <string>

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/abilities/columns.hpp"

namespace pkm::generic {

/// @param evaluation  must outlive the result
std::unique_ptr<const PoseSides> prepare_pose_sides(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                    const std::string& mode);

}  // namespace pkm::generic
