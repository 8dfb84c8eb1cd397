// The options --largest-box, --largest-cylinder and --largest-sphere: the largest solids in the workspace of a design.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/workspace/largest_solid.hpp"
#include "engine/workspace/slices.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

struct SolidArguments {
  bool box = false, cylinder = false, sphere = false;
  std::string ratio, axis;
  std::vector<std::string> centre, least;
  bool singular = false;
};
/// Declares --largest-box, --largest-cylinder, --largest-sphere and their further options.
void add_solid_options(CLI::App& command, SolidArguments& arguments);

/// A solid that the options request.
struct RequestedSolid {
  std::string name;  ///< word for the solid in messages, such as "box"
  std::unique_ptr<const LargestSolidFinder> finder;
};
/// The requested solids, ready to be found under a plan with voxels. Throws ConfigError if the options do
/// not fit the plan.
/// @param slices  coordinates that the plan sweeps and that are fixed for the solids
std::vector<RequestedSolid> requested_solids(const SolidArguments& arguments, const Target& target, WorkspacePlan plan,
                                             const Slices& slices);

/// Finds the solids and adds them to the output.
void report_solids(const std::vector<RequestedSolid>& requested, const Target& target, Printout& out);

}  // namespace pkm
