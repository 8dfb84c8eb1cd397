// The options --cube and --least: the largest cube of feasible cells in a workspace, or the largest square if two
// coordinates are swept.
#pragma once

#include <string>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Values of the options --cube and --least.
struct CubeArguments {
  bool cube = false;
  std::vector<std::string> least;
};
/// Declares --cube and --least.
void add_cube_options(CLI::App& command, CubeArguments& arguments);

/// Throws ConfigError if a cube is requested and the swept coordinates are not two or three lengths.
void expect_length_axes(const Axes& swept, const CubeArguments& arguments);
/// Throws ConfigError if --least names a field that the workspace lacks, or one that the mechanism does not define.
void expect_known_fields(const WorkspaceFields& workspace, const MechanismInfo& info, const CubeArguments& arguments);

/// If requested, adds to the output the largest cube of feasible cells that satisfy the minimum values of --least.
void report_largest_cube(const WorkspaceFields& workspace, const CubeArguments& arguments, Printout& out);

}  // namespace pkm
