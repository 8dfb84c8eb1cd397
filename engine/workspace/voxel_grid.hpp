// A box of voxels over the swept coordinates, an axis without one having a single cell [0, 1]: cell k of axis i has its
// centre at lower + (k + 1/2) step.
#pragma once

#include <array>
#include <cstdint>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

using Cell = std::array<std::int64_t, 3>;  ///< its numbers along the axes

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
  double centre(std::size_t axis, std::int64_t k) const {
    return lower[axis] + (static_cast<double>(k) + 0.5) * step[axis];
  }
  /// Of a cell in a map.
  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>((cell[0] * cells[1] + cell[1]) * cells[2] + cell[2]);
  }
  bool at_end(std::size_t axis, std::int64_t k) const { return k == 0 || k == cells[axis] - 1; }
  std::int64_t count() const { return cells[0] * cells[1] * cells[2]; }
  double cell_volume() const { return step[0] * step[1] * step[2]; }

  /// A map of this grid with no feasible cell.
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

/// Volume, counts and box contact of a map.
/// @param swept  number of coordinates: the axes behind them touch nothing
inline void summarise(const VoxelGrid& grid, const VoxelMap& map, Survey<double>& survey, std::size_t swept = 3) {
  survey.clear();
  survey.cells = grid.count();
  survey.cell_volume = grid.cell_volume();
  std::size_t cell = 0;
  const auto outer = [&](std::size_t axis, std::int64_t k) { return axis < swept && grid.at_end(axis, k); };
  for (std::int64_t i = 0; i < grid.cells[0]; ++i)
    for (std::int64_t j = 0; j < grid.cells[1]; ++j)
      for (std::int64_t k = 0; k < grid.cells[2]; ++k) {
        if (!map.feasible[cell++]) continue;
        ++survey.feasible_cells;
        survey.touches_box = survey.touches_box || outer(0, i) || outer(1, j) || outer(2, k);
      }
  survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
}

}  // namespace pkm
