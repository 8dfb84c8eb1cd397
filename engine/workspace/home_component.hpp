// Voxel analysis of the component of the workspace that holds the home pose (WorkspacePlan::home).
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Prepares an evaluator that counts only the cells of the component that contains the home pose. A design whose home
/// pose is infeasible, singular or outside of the grid throws DesignError. Throws std::invalid_argument if the plan is
/// not supported.
/// @param map      evaluator of the same plan without a home pose, without samples
/// @param samples  evaluator of the same plan with the samples of the request and with FieldRequest::every_pose; null
///                 if no samples are requested
std::unique_ptr<const VoxelEvaluator> prepare_home_component(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                             const FieldRequest& request,
                                                             std::unique_ptr<const VoxelEvaluator> map,
                                                             std::unique_ptr<const VoxelEvaluator> samples);

}  // namespace pkm
