// Voxel surveys of a description: every formula in the outermost loop that it can stand in, rows of cells side by side.
#pragma once

#include <memory>

#include "engine/mechanisms/described/evaluation.hpp"

namespace pkm::described {

/// Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
/// @param mechanism, evaluation  outlive the surveyor
std::unique_ptr<const VoxelSurveyor> prepare_voxels(const Mechanism& mechanism, const Evaluation& evaluation,
                                                    const SurveyPlan& plan, const VoxelOptions& voxels,
                                                    const Demand& demand);

}  // namespace pkm::described
