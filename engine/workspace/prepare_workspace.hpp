// Factory of workspace evaluators: selects the mechanism's own columns or voxels, otherwise cellwise voxels, and
// averages the analyses of plans with lists of fixed values.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

/// Creates the evaluator of a plan. If the plan lists values of fixed coordinates, the result is the average of the
/// analyses at all values (at all combinations, if there are several lists): the samples are in the order of the
/// values, weights and volume are divided by their number. Throws std::invalid_argument with one sentence if the plan
/// is not supported.
std::unique_ptr<const WorkspaceEvaluator> prepare_workspace(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                            const FieldRequest& request);

/// The first requested quantity that only cellwise voxels compute, or null: a quantity of pose reports other than the
/// conditioning.
const PoseQuantity* first_cellwise_field(const FieldRequest& request);

/// Creates the evaluator of a voxel plan, for maps of many designs. Throws std::invalid_argument with one sentence if
/// the plan is not supported.
/// @param mode  working mode; "": the first
std::unique_ptr<const VoxelEvaluator> prepare_voxel_map(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                        const std::string& mode = "");

/// The voxel map of one design. Throws std::invalid_argument with one sentence if the plan is not supported.
VoxelMap voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan);

}  // namespace pkm
