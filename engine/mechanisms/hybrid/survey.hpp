// Hybrid robot: the surveys of a plan. They are of one working mode.
//
// Links count as capsules only where the plan gives a clearance, on voxels; a pose by itself is reported with the
// links' distances in any case.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/hybrid/limits.hpp"

namespace pkm::hybrid {

struct Planned {
  WorkingMode signs;
  int branch;  ///< required sign of N2, +1 or -1
  SurveyPlan plan;
  Demand demand;
};

/// Throws std::invalid_argument with a sentence when the plan cannot be served.
std::unique_ptr<const Surveyor> make_surveyor(const Planned& planned, const ColumnOptions& columns);
std::unique_ptr<const VoxelSurveyor> make_surveyor(const Planned& planned, const VoxelOptions& voxels);

}  // namespace pkm::hybrid
