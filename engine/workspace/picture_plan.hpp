// The voxels that picture the workspace of a study, whichever way it surveys it.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The plan itself, if it counts voxels, else voxels with the same limits and box; on one value of the held coordinate:
/// the plan's, or the design's middle where it integrates.
/// @param cells  for a plan of columns, which has none
inline WorkspacePlan picture_plan(const MechanismInfo& info, const WorkspacePlan& plan,
                                  const std::array<std::int64_t, 3>& cells) {
  WorkspacePlan picture = plan;
  if (const ColumnOptions* const columns = plan.columns()) {
    VoxelOptions voxels{.cells = cells, .box = columns->box};
    for (std::size_t i = sweep_of(info, plan).swept.size(); i < 3; ++i) voxels.cells[i] = 1;
    picture.method = voxels;
  }
  for (FixedCoordinate& held : picture.held) {
    if (held.kind == FixedCoordinate::Kind::listed)
      held = {held.coordinate, FixedCoordinate::Kind::value, held.values[0]};
    if (held.kind == FixedCoordinate::Kind::integrated) held = {held.coordinate};
  }
  return picture;
}

}  // namespace pkm
