// The options --fixed and --cut, which fix coordinates of a workspace at given values.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/workspace/slices.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Fixes the coordinates that --fixed names at the given values. A coordinate that no sweep of the mechanism keeps
/// fixed becomes a slice. If the plan's sweep can fix the other named coordinates, the coordinates that the plan
/// already fixes stay fixed. Otherwise another sweep is selected, and the fixed coordinates, the method and the home
/// pose of the plan are reset, because they belong to other axes. Throws ConfigError.
/// @param lists  values of --fixed, lists of NAME=VALUE
/// @return the slices
Slices set_fixed_coordinates(WorkspacePlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists);

/// Adds the slices that --cut defines, for coordinates that the plan sweeps. Throws ConfigError.
void add_cuts(Slices& slices, const WorkspacePlan& plan, const MechanismInfo& info,
              const std::vector<std::string>& lists);

/// The swept coordinates of the plan that are not sliced.
Axes swept_axes(const WorkspacePlan& plan, const MechanismInfo& info, const Slices& slices);

/// Reduces the range of each sliced coordinate to one thin cell. If no box is specified, it encloses the reachable
/// poses. Throws ConfigError.
/// @param plan          a plan with voxels
/// @param ranges_given  for each swept coordinate, true if its range was specified (see set_grid()); set to false for
///   sliced coordinates
void apply_slices(WorkspacePlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given);

}  // namespace pkm
