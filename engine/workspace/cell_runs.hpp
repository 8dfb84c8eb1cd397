// Feasible cells of a grid as runs of neighbours along one axis, or as rows of bits.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// The cells from `first` on that have numbers below `end` along an axis.
struct CellRun {
  Cell first;
  std::size_t axis;
  std::int64_t end;

  std::int64_t count() const { return end - first[axis]; }
};

/// Whether one of them lies on the outer layer of the box.
inline bool touches_box(const VoxelGrid& grid, const CellRun& run) {
  bool touches = run.end == grid.cells[run.axis];
  for (std::size_t axis = 0; axis < 3; ++axis) touches = touches || grid.at_end(axis, run.first[axis]);
  return touches;
}

/// Adds the cells of a run to those that a survey has found.
/// @param images  of the run, itself among them: mirrored ones have the same cells
inline void count_cells(const VoxelGrid& grid, const CellRun& run, Survey<double>& to, int images = 1) {
  to.feasible_cells += run.count() * images;
  to.touches_box = to.touches_box || touches_box(grid, run);
}

/// Calls visit(cell) for every cell of a run.
template <class Visit>
void for_each_cell(const CellRun& run, const Visit& visit) {
  for (Cell cell = run.first; cell[run.axis] < run.end; ++cell[run.axis]) visit(cell);
}

/// Calls visit(run) for the runs of those cells that pass a test.
template <class Test, class Visit>
void keep_cells(const CellRun& run, const Test& passes, const Visit& visit) {
  CellRun kept = run;
  std::int64_t& start = kept.first[run.axis];
  for_each_cell(run, [&](const Cell& cell) {
    if (passes(cell)) return;
    kept.end = cell[run.axis];
    if (start < kept.end) visit(kept);
    start = kept.end + 1;
  });
  kept.end = run.end;
  if (start < kept.end) visit(kept);
}

/// Calls visit(number) for every bit of a row, from the first on.
template <class Visit>
void for_each_bit(std::span<const std::uint64_t> row, const Visit& visit) {
  for (std::size_t w = 0; w < row.size(); ++w)
    for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1)
      visit(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Calls visit(first, end) for every run of neighbouring bits.
template <class Visit>
void for_each_run(std::span<const std::uint64_t> row, const Visit& visit) {
  std::size_t first = 0, end = 0;  // of the run so far
  for_each_bit(row, [&](std::size_t bit) {
    if (bit != end) {
      if (first < end) visit(first, end);
      first = bit;
    }
    end = bit + 1;
  });
  if (first < end) visit(first, end);
}

}  // namespace pkm
