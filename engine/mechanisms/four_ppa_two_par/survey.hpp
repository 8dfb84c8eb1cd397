// 4PPa-2PaR: the surveys of a plan, and the report on one pose.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

/// Throws std::invalid_argument with a sentence when the plan cannot be served.
std::unique_ptr<const Surveyor> make_column_surveyor(const SurveyPlan& plan, const ColumnOptions& columns,
                                                     const Demand& demand);
std::unique_ptr<const Surveyor> make_voxel_surveyor(const SurveyPlan& plan, const VoxelOptions& voxels,
                                                    const Demand& demand);

VoxelMap voxel_map(const Geometry<double>& g, const SurveyPlan& plan, const VoxelOptions& voxels);

PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Pose<double>& pose, WorkingMode mode);

}  // namespace pkm::four_ppa_two_par
