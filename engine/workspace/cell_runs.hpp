// Runs of feasible cells: neighbours along one axis of a grid, or consecutive set bits of a bit row.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "engine/workspace/voxel_grid.hpp"

namespace pkm {

/// The cells whose index along `axis` is at least first[axis] and less than `end`; their other indices are those of
/// `first`.
struct CellRun {
  Cell first;
  std::size_t axis;
  std::int64_t end;

  std::int64_t count() const { return end - first[axis]; }
};

/// Adds the number of cells of a run, and its contact with the border of the grid, to a result.
/// @param images  number of copies of the run by symmetry, including itself; all of them are counted
inline void count_cells(const VoxelGrid& grid, const CellRun& run, WorkspaceResult<double>& to, int images = 1) {
  to.feasible_cells += run.count() * images;
  to.touches_box = to.touches_box || run.end == grid.cells[run.axis] || grid.is_outermost(run.first);
}

/// Calls visit(cell) for every cell of a run.
template <class Visit>
void for_each_cell(const CellRun& run, const Visit& visit) {
  for (Cell cell = run.first; cell[run.axis] < run.end; ++cell[run.axis]) visit(cell);
}

/// Calls visit(part) for each part of a run that is a maximal run of cells that satisfy a predicate.
template <class Predicate, class Visit>
void filter_run(const CellRun& run, const Predicate& passes, const Visit& visit) {
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

/// Calls visit(index) for every set bit of a row, in ascending order.
template <class Visit>
void for_each_bit(std::span<const std::uint64_t> row, const Visit& visit) {
  for (std::size_t w = 0; w < row.size(); ++w)
    for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1)
      visit(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Calls visit(first, end) for every maximal run of consecutive set bits.
template <class Visit>
void for_each_run(std::span<const std::uint64_t> row, const Visit& visit) {
  std::size_t first = 0, end = 0;
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
