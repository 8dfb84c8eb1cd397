// (3CRR/R)&CRU and Quadrupteron: the surveys of a plan.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"

namespace pkm::crr_cru {

/// @param held  number of the coordinate that the plan holds
/// @param mode  of the coupling that is demanded
/// @param plan  without a clearance
std::unique_ptr<const Surveyor> make_column_surveyor(Platform platform, MassModel mass_model, const WorkingMode& mode,
                                                     int held, const SurveyPlan& plan, const ColumnOptions& columns,
                                                     const Demand& demand);

/// @param held  number of the coordinate that the plan holds
/// @param mode  of the coupling that is demanded and of a clearance; else feasibility does not depend on it
std::unique_ptr<const Surveyor> make_voxel_surveyor(Platform platform, MassModel mass_model, const WorkingMode& mode,
                                                    int held, const SurveyPlan& plan, const VoxelOptions& voxels,
                                                    const Demand& demand);

VoxelMap voxel_map(Platform platform, const WorkingMode& mode, int held, std::span<const double> parameters,
                   const SurveyPlan& plan, const VoxelOptions& voxels);

}  // namespace pkm::crr_cru
