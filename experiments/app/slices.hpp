// The options --fixed and --cut, which fix coordinates of a workspace at given values.
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

/// Adds the slices that --cut defines, for coordinates that the plan sweeps. Throws ConfigError.
void add_cuts(Slices& slices, const WorkspacePlan& plan, const MechanismInfo& info,
              const std::vector<std::string>& lists);

/// The swept coordinates that are not sliced.
Axes swept_axes(const WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices);

/// Reduces the range of each sliced coordinate to one thin cell. If no box is specified, it encloses the reachable
/// poses. Throws ConfigError.
/// @param plan          a plan with voxels
/// @param ranges_given  for each swept coordinate, see set_grid(); becomes false for slices
void apply_slices(WorkspacePlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given);

}  // namespace pkm
