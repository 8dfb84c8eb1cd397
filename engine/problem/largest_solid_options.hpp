// Options of the largest box, cylinder or sphere in the workspace, and the quantities of a study that measure one.
#pragma once

#include "engine/problem/design_problem.hpp"
#include "engine/problem/quantity.hpp"
#include "engine/workspace/largest_solid.hpp"

namespace pkm {

std::vector<OptionSpec> largest_solid_options(SolidKind kind);

/// True if the quantity is the solid's first dimension (edge or diameter); false if it is the volume.
/// @param options  values of largest_solid_options()
bool measures_size(const Options& options);

/// Requirements on the largest solid of a kind in the workspaces that a plan defines. Throws std::invalid_argument with
/// one sentence if the options do not fit the plan.
/// @param options  values of largest_solid_options()
SolidSpec solid_spec(SolidKind kind, const MechanismInfo& info, const WorkspacePlan& plan, const Options& options);

/// The object that finds the largest solid, for the options and the plan of a catalogue entry. Throws
/// std::invalid_argument with one sentence if the options do not fit the plan, or the solid cannot be found in its
/// workspaces.
LargestSolidFinder solid_finder(SolidKind kind, const EntryContext& context);

/// The objectives, constraints and outputs that measure a largest solid.
std::vector<const NamedQuantity*> solid_measures(const ProblemParts& parts);

}  // namespace pkm
