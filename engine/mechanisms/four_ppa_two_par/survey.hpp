// 4PPa-2PaR: the surveys of a plan.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/four_ppa_two_par/inspect.hpp"

namespace pkm::four_ppa_two_par {

/// Throws std::invalid_argument with a sentence when the plan cannot be served.
std::unique_ptr<const Surveyor> make_column_surveyor(const SurveyPlan& plan, const ColumnOptions& columns,
                                                     const Demand& demand);
std::unique_ptr<const VoxelSurveyor> make_voxel_surveyor(const SurveyPlan& plan, const VoxelOptions& voxels,
                                                         const Demand& demand);

}  // namespace pkm::four_ppa_two_par
