// Slices of a workspace: swept coordinates that are fixed at a value. The workspace analysis uses a single, thin layer
// of cells around the value; the volume is then divided by the thickness of the layer, which gives an area or a length.
#pragma once

#include <map>

#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// Values [m or rad] of the sliced coordinates, by index of the coordinate.
using Slices = std::map<int, double>;

/// Replaces the range of each sliced coordinate by one thin cell.
/// @param plan  a voxel plan with a box
void set_thin_layers(WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices);

/// Converts the sliced axes to fixed coordinates, and the volume to the area or length over the remaining axes.
/// @param workspace  fields of a plan that set_thin_layers() has modified
void remove_sliced_axes(WorkspaceFields& workspace, const MechanismInfo& info, const Slices& slices);

}  // namespace pkm
