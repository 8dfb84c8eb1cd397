// Which voxels a command looks at: --box and --cells.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

struct GridArguments {
  std::vector<std::string> box, cells;
};

/// Declares --box and --cells.
/// @param usual  cells along each axis where neither the command line nor a study says
void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t usual);

/// As many cells along each swept coordinate.
VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells);

/// The box of all swept coordinates that a target reaches under a plan. Throws ConfigError where it does not say.
Box reached_box(const SurveyPlan& plan, const Target& target);

/// Sets cells and box of a plan, which is one of voxels then, what it holds being chosen. Throws ConfigError.
/// @param most  cells in all
/// @return by swept coordinate, whether the command or the study gives its range, so that more may lie beyond
std::array<bool, 3> set_grid(SurveyPlan& plan, const Target& target, const GridArguments& arguments, std::int64_t usual,
                             double most);

}  // namespace pkm
