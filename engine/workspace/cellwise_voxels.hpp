// Exhaustive grid sampling: voxel analysis of any mechanism by inverse kinematics at the centre of every cell. It is
// the reference in tests of faster voxel evaluators.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Prepares an evaluator of voxels over one to three swept coordinates. Every other coordinate is either fixed, or its
/// range in the mechanism is divided into cells over which the volume is integrated. Throws std::invalid_argument, with
/// the reason in one sentence, if the plan is not supported.
std::unique_ptr<const VoxelEvaluator> prepare_cellwise_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                              const VoxelOptions& voxels, const FieldRequest& request);

}  // namespace pkm
