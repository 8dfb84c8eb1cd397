// Which voxels a command looks at: --box and --cells.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

struct GridArguments {
  std::vector<std::string> box, cells;
};

/// Declares --box and --cells.
/// @param usual  cells along each axis where neither the command line nor a study says
void add_grid_options(CLI::App& command, GridArguments& arguments, std::int64_t usual);

/// As many cells along each swept coordinate.
VoxelOptions equal_cells(const Sweep& sweep, std::int64_t cells);

/// Sets cells and box of a plan, which is one of voxels then, what it holds being chosen. Throws ConfigError.
/// @param most  cells in all
void set_grid(SurveyPlan& plan, const MechanismInfo& info, const GridArguments& arguments, std::int64_t usual,
              double most);

}  // namespace pkm
