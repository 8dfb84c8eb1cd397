// The largest cube of poses within a workspace, or square where two coordinates are swept.
#pragma once

#include <string>
#include <vector>

#include "engine/report/workspace_fields.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

struct CubeArguments {
  bool cube = false;
  std::vector<std::string> least;
};
/// Declares --cube and --least.
void add_cube_options(CLI::App& command, CubeArguments& arguments);

/// Throws ConfigError where a cube is asked for and what is swept is not two or three lengths.
void expect_lengths(const Axes& swept, const CubeArguments& arguments);
/// Throws ConfigError where the workspace does not have the fields that --least names, or no design has values of one.
void expect_fields(const WorkspaceFields& workspace, const MechanismInfo& info, const CubeArguments& arguments);

/// Tells the largest cube of cells that are feasible and have the least values asked for, if one is asked for. Of
/// several, the one in their midst.
void tell_cube(const WorkspaceFields& workspace, const CubeArguments& arguments, Printout& out);

}  // namespace pkm
