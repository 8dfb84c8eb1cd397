// Cells of fixed coordinates that a voxel analysis integrates over: one grid for each combination of their cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mechanism/plan.hpp"

namespace pkm {

/// The cells of a coordinate that is integrated over: `cells` equal cells in [lower, lower + cells * step].
struct FixedCells {
  std::size_t coordinate;
  double lower, step;
  std::int64_t cells;

  double centre(std::int64_t cell) const { return lower + (static_cast<double>(cell) + 0.5) * step; }
};

/// Finds the cells of all coordinates that a plan integrates over.
/// @param coordinates  indices of the fixed coordinates of the plan's sweep
/// @param range_of     range_of(coordinate): the range that is divided into cells
/// @param all          receives the cells of each integrated coordinate; previous contents are discarded
template <class RangeOf>
void find_fixed_cells(std::span<const int> coordinates, const WorkspacePlan& plan, const RangeOf& range_of,
                      std::vector<FixedCells>& all) {
  all.clear();
  for (const int coordinate : coordinates) {
    const FixedCoordinate fixed = how_fixed(plan, coordinate);
    if (fixed.kind != FixedCoordinate::Kind::integrated) continue;
    const auto [lower, upper] = range_of(coordinate);
    all.push_back(
        {static_cast<std::size_t>(coordinate), lower, (upper - lower) / static_cast<double>(fixed.cells), fixed.cells});
  }
}

/// Sets each coordinate that is integrated over to the centre of one of its cells.
/// @param number      number of the combination of cells, from 0; the cell of the first coordinate varies fastest
/// @param coordinate  coordinate(index): reference to the value of a coordinate
template <class Coordinates>
void set_fixed_cells(std::span<const FixedCells> fixed, std::size_t number, const Coordinates& coordinate) {
  for (const FixedCells& each : fixed) {
    const auto cells = static_cast<std::size_t>(each.cells);
    coordinate(each.coordinate) = each.centre(static_cast<std::int64_t>(number % cells));
    number /= cells;
  }
}

}  // namespace pkm
