// Regular voxel grid over the swept coordinates. Cell k of axis i has its centre at lower + (k + 1/2) step; an axis
// without a coordinate has the single cell [0, 1].
#pragma once

#include <array>
#include <cstdint>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm {

using Cell = std::array<std::int64_t, 3>;  ///< indices of a cell along the axes

struct VoxelGrid {
  std::array<std::int64_t, 3> cells{};
  std::array<double, 3> lower{}, upper{}, step{};

  VoxelGrid(const std::array<std::int64_t, 3>& n, const Box& box) : cells(n) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = box[i][0];
      upper[i] = box[i][1];
      step[i] = (upper[i] - lower[i]) / static_cast<double>(cells[i]);
    }
  }
  explicit VoxelGrid(const VoxelMap& map)
      : VoxelGrid({map.cells[0], map.cells[1], map.cells[2]},
                  {{{map.lower[0], map.upper[0]}, {map.lower[1], map.upper[1]}, {map.lower[2], map.upper[2]}}}) {}
  double centre(std::size_t axis, std::int64_t k) const {
    return lower[axis] + (static_cast<double>(k) + 0.5) * step[axis];
  }
  /// Index of a cell in VoxelMap::feasible.
  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>((cell[0] * cells[1] + cell[1]) * cells[2] + cell[2]);
  }
  /// @return true for the first and the last cell of an axis
  bool at_end(std::size_t axis, std::int64_t k) const { return k == 0 || k == cells[axis] - 1; }
  /// @return true if a cell is at an end of any of the first `axes` axes
  bool is_outermost(const Cell& cell, std::size_t axes = 3) const {
    for (std::size_t axis = 0; axis < axes; ++axis)
      if (at_end(axis, cell[axis])) return true;
    return false;
  }
  std::int64_t count() const { return cells[0] * cells[1] * cells[2]; }
  double cell_volume() const { return step[0] * step[1] * step[2]; }

  /// A map of this grid without feasible cells.
  VoxelMap map() const {
    VoxelMap m;
    m.feasible.assign(static_cast<std::size_t>(count()), 0);
    for (std::size_t i = 0; i < 3; ++i) {
      m.cells[i] = cells[i];
      m.lower[i] = lower[i];
      m.upper[i] = upper[i];
    }
    return m;
  }
};

/// Computes volume, cell counts and contact with the box from a voxel map.
/// @param swept  number of swept coordinates; cells at the ends of the other axes do not touch the box
inline void summarise(const VoxelGrid& grid, const VoxelMap& map, WorkspaceResult<double>& result,
                      std::size_t swept = 3) {
  result.clear();
  result.cells = grid.count();
  result.cell_volume = grid.cell_volume();
  Cell cell;
  for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2]) {
        if (!map.feasible[grid.index(cell)]) continue;
        ++result.feasible_cells;
        result.touches_box = result.touches_box || grid.is_outermost(cell, swept);
      }
  result.volume = static_cast<double>(result.feasible_cells) * result.cell_volume;
}

}  // namespace pkm
