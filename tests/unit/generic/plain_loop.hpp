// The loop over all poses: slow and obviously right, what counts from column intervals are compared with.
#pragma once

#include "engine/workspace/voxel_grid.hpp"

namespace pkm::testing {

/// Tests every cell's centre, `feasible(c0, c1, c2)` with the coordinates in the order of the axes.
template <class Test>
VoxelMap test_every_cell(const VoxelGrid& grid, const Test& feasible) {
  VoxelMap map = grid.map();
  std::size_t cell = 0;
  for (std::int64_t i = 0; i < grid.cells[0]; ++i)
    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
      for (std::int64_t k = 0; k < grid.cells[2]; ++k)
        map.feasible[cell++] = feasible(grid.centre(0, i), grid.centre(1, j), grid.centre(2, k)) ? 1 : 0;
  return map;
}

}  // namespace pkm::testing
