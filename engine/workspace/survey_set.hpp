// Surveys of any plan by any mechanism: by its own columns or voxels, else cell by cell; also where a held coordinate
// takes a list of values.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {

/// The surveyor of a plan. A plan that lists values of held coordinates gives the surveys at all of them (and at all
/// combinations, if there are several lists) as one: samples in the order of the values, weights and volume divided by
/// their number. Throws std::invalid_argument with a sentence when the mechanism cannot serve the plan.
std::unique_ptr<const WorkspaceEvaluator> prepare_workspace(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                            const Demand& demand);

/// The first demanded field that mechanisms do not compute themselves, but cell by cell, so that columns have it not:
/// made of reports of poses, other than conditioning. Null: none.
const PoseQuantity* of_cells_only(const Demand& demand);

/// What shows the cells of a voxel plan, for many designs. It throws the same.
std::unique_ptr<const VoxelEvaluator> prepare_map(const Mechanism& mechanism, const WorkspacePlan& plan);

/// The cells of a voxel plan for one design (the plan's cells; box as in a survey). It throws the same.
VoxelMap voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan);

}  // namespace pkm
