// Voxel surveys of any mechanism, from its inverse kinematics alone: the centre of every cell is tested. What a
// mechanism has that is faster is tested against it.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Surveys over one to three coordinates, the others held or integrated over (by their own cells, within the
/// mechanism's ranges). Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
std::unique_ptr<const Surveyor> prepare_plain_voxels(const Mechanism& mechanism, const SurveyPlan& plan,
                                                     const VoxelOptions& voxels, const Demand& demand);

VoxelMap plain_voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const SurveyPlan& plan,
                         const VoxelOptions& voxels);

}  // namespace pkm
