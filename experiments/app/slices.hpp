// The options --held and --cut, which fix coordinates of a workspace at a value.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/workspace/slices.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Fixes the coordinates named by --fixed at their values. Those that no sweep of the mechanism keeps fixed become
/// slices. If the sweep of the plan can fix the others, the coordinates that the plan has fixed stay fixed. Otherwise
/// another sweep is selected, and fixed coordinates, method and home pose are reset, because they belong to other axes.
/// Throws ConfigError.
/// @param lists  of --fixed: name=value
/// @return the slices
Slices set_fixed_coordinates(WorkspacePlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists);

/// Adds the slices that --cut names, of coordinates that the plan sweeps. Throws ConfigError.
void add_cuts(Slices& slices, const WorkspacePlan& plan, const MechanismInfo& info,
              const std::vector<std::string>& lists);

/// The swept coordinates that are not sliced.
Axes swept_axes(const WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices);

/// Replaces the range of each sliced coordinate by one thin cell; a box that is not specified encloses the reachable
/// poses. Throws ConfigError.
/// @param plan          of voxels
/// @param ranges_given  by swept coordinate, see set_grid(); reset for slices
void apply_slices(WorkspacePlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given);

}  // namespace pkm
