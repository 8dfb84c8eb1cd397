// The largest axis-parallel cube of cells in a workspace, with a summed-area table (3-D prefix sums) of the other
// cells; the largest square if two coordinates are swept.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

struct CellCube {
  double side = 0;                     ///< a whole number of cells along at least one axis
  std::array<std::size_t, 3> first{};  ///< the cell of the cube with the lowest indices
};

/// The largest cube of good cells. Among several cubes of this size, the one closest to the mean of their positions.
/// @param good  whether each cell is good, by index; all swept coordinates must have the same unit
/// @return std::nullopt if no cell is good
std::optional<CellCube> largest_cube(const WorkspaceFields& workspace, const std::vector<bool>& good);

}  // namespace pkm
