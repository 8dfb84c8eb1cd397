// Voxel surveys of any mechanism, from its inverse kinematics alone: the centre of every cell is tested. What a
// mechanism has that is faster is tested against it.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Surveys over one to three coordinates, the others held or integrated over (by their own cells, within the
/// mechanism's ranges). Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
std::unique_ptr<const VoxelEvaluator> prepare_plain_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                           const VoxelOptions& voxels, const Demand& demand);

}  // namespace pkm
