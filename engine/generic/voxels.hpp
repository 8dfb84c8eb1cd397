// Voxel analyses of a mechanism file, with loop-invariant code motion over the swept coordinates and SIMD batches of
// cells.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Search box as a function of the design, for plans that give no box.
using BoxOfDesign = std::function<Box(std::span<const double> parameters)>;

/// Makes the evaluator of voxels for a plan. Throws std::invalid_argument with a message if the mechanism does not
/// support the plan.
/// @param evaluation   must outlive the evaluator
/// @param default_box  search box of plans without one; null: the box of the mechanism file is used
std::unique_ptr<const VoxelEvaluator> prepare_voxels(const Evaluation& evaluation, const WorkspacePlan& plan,
                                                     const VoxelOptions& voxels, const FieldRequest& request,
                                                     BoxOfDesign default_box = {});

}  // namespace pkm::generic
