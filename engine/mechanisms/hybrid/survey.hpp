// Hybrid robot: the surveys of a plan. They are of one working mode.
//
// Links count as capsules only where the plan gives a clearance, on voxels; a pose by itself is reported with the
// links' distances in any case.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/hybrid/limits.hpp"

namespace pkm::hybrid {

/// @param branch  required sign of N2, +1 or -1
/// Throws std::invalid_argument with a sentence when the plan cannot be served.
std::unique_ptr<const Surveyor> make_column_surveyor(const WorkingMode& signs, int branch, const SurveyPlan& plan,
                                                     const ColumnOptions& columns, const Demand& demand);
std::unique_ptr<const Surveyor> make_voxel_surveyor(const WorkingMode& signs, int branch, const SurveyPlan& plan,
                                                    const VoxelOptions& voxels, const Demand& demand);

VoxelMap voxel_map(const WorkingMode& signs, int branch, std::span<const double> parameters, const SurveyPlan& plan,
                   const VoxelOptions& voxels);

}  // namespace pkm::hybrid
