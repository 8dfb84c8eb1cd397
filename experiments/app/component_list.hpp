// The connected components of a workspace, for `pkmopt workspace`.
#pragma once

#include <string>

#include "experiments/app/print.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Adds the connected components of the workspace to the output, with their shares and extents. The text lists them if
/// there are several, or if the plan has a home pose.
/// @param plan  a plan with voxels
void report_components(const Target& target, const WorkspacePlan& plan, Printout& out);

}  // namespace pkm
