// Slices through a workspace: swept coordinates that are left at a value. A survey looks at one cell there, thin and
// around the value, and what is found counts for a plane or a line.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "engine/report/workspace_fields.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Values [m or rad] by coordinate.
using Slices = std::map<int, double>;

/// Holds the coordinates that --held names at their values; those that no survey of the mechanism holds are slices.
/// Others that the study holds stay as they are where its sweep serves; where another does, the study's box and cells
/// are of other axes. Throws ConfigError.
Slices set_held(SurveyPlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists);

/// Slices of --cut, through what the plan sweeps. Throws ConfigError.
void add_cuts(Slices& slices, const SurveyPlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists);

/// The coordinates that are swept, but for slices.
Axes swept_axes(const SurveyPlan& plan, const MechanismInfo& info, const Slices& slices);

/// Makes a plan of voxels one of slices.
/// @param ranges_given  by swept coordinate; that of a slice is not
void cut(SurveyPlan& plan, const Target& target, const Slices& slices, std::array<bool, 3>& ranges_given);

/// Makes axes that are slices held coordinates, and the volume that of what is left.
void flatten(WorkspaceFields& workspace, const MechanismInfo& info, const Slices& slices);

}  // namespace pkm
