// Exhaustive grid sampling: voxel analysis of any mechanism by inverse kinematics at the centre of every cell. It is
// the reference in tests of faster voxel evaluators.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Evaluator over one to three swept coordinates; the others are fixed or integrated over by cells within the
/// mechanism's ranges. Throws std::invalid_argument with one sentence if the plan is not supported.
std::unique_ptr<const VoxelEvaluator> prepare_cellwise_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                              const VoxelOptions& voxels, const FieldRequest& request);

}  // namespace pkm
