// The options --box and --cells, which define the voxel grid of a command.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/config/assignments.hpp"
#include "engine/workspace/slices.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Values of the options --box and --cells: lists of assignments.
struct GridArguments {
  std::vector<std::string> box, cells;
};

/// Declares --box and --cells.
/// @param default_cells  number of cells along each axis if neither the command line nor a study specifies it
void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t default_cells);

/// The swept coordinates, as names to which --box and --cells may assign values.
std::vector<Assignable> assignable_coordinates(const MechanismInfo& info, const Sweep& sweep);

/// Parses --home: values of all swept coordinates, in the order of Sweep::swept. Throws ConfigError.
std::array<double, 3> parse_home(const std::vector<std::string>& lists, const MechanismInfo& info, const Sweep& sweep);

/// Parses the option --box as a box of poses. Throws ConfigError if the range of a swept coordinate is missing.
/// @return the range of each coordinate; coordinates that are not swept have their fixed value
std::vector<std::array<double, 2>> parse_pose_box(const Target& target, const WorkspacePlan& plan,
                                                  const std::vector<std::string>& box);

/// A grid with the same number of cells along each swept coordinate.
VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells);

/// The box of the swept coordinates that encloses all poses the design can reach. Throws ConfigError if it is unknown.
Box reachable_box(const WorkspacePlan& plan, const Target& target);

/// Changes the method of a plan to voxels. Numbers of cells and box are those of the command line; if it does not give
/// them, those of the study, otherwise default values. The fixed coordinates of the plan must have been set before.
/// Throws ConfigError.
/// @param max_cells  maximum total number of cells
/// @param sliced     swept coordinates that are cut at a value, which have a single cell
/// @return for each swept coordinate, true if its range was specified, so that feasible poses may exist beyond it
std::array<bool, 3> set_grid(WorkspacePlan& plan, const Target& target, const GridArguments& arguments,
                             std::int64_t default_cells, double max_cells, const Slices& sliced = {});

}  // namespace pkm
