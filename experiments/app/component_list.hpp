// The connected components of a workspace, for `pkmopt workspace`.
#pragma once

#include <string>

#include "experiments/app/print.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Adds the components of the workspace to the output: shares and extents. The text lists them if there are several, or
/// if the plan has a home pose.
/// @param plan  of voxels
void report_components(const Target& target, const WorkspacePlan& plan, Printout& out);

}  // namespace pkm
