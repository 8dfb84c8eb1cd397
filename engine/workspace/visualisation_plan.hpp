// Voxel plan for the visualisation of a study's workspace, whichever method the study uses.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A voxel plan with the same limits and box as `plan`, and one value of each fixed coordinate: the plan's value, the
/// first one of a list, or the default value of the design if the plan integrates over it.
/// @param cells  number of cells if `plan` uses columns; a voxel plan keeps its own cells
inline WorkspacePlan visualisation_plan(const MechanismInfo& info, const WorkspacePlan& plan,
                                        const std::array<std::int64_t, 3>& cells) {
  WorkspacePlan result = plan;
  if (const ColumnOptions* const columns = plan.columns()) {
    VoxelOptions voxels{.cells = cells, .box = columns->box};
    for (std::size_t i = sweep_of(info, plan).swept.size(); i < 3; ++i) voxels.cells[i] = 1;
    result.method = voxels;
  }
  for (FixedCoordinate& fixed : result.fixed) {
    if (fixed.kind == FixedCoordinate::Kind::listed)
      fixed = {fixed.coordinate, FixedCoordinate::Kind::value, fixed.values[0]};
    if (fixed.kind == FixedCoordinate::Kind::integrated) fixed = {fixed.coordinate};
  }
  return result;
}

}  // namespace pkm
