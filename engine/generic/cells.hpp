// Which cells of a grid are feasible. Conditions that are quadratic along the innermost coordinate end columns in
// closed form, so that their cells are counted; what is left of the others is tested in rows, where columns have cells
// at all.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/generic/cell_plan.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::generic {

/// What a worker overwrites.
struct CellRoom {
  std::vector<double> registers;
  expression::Rows middle_rows, rows;
  std::vector<std::uint64_t> bits;  ///< of a slice, where they are asked for: words() words for each column
  std::vector<std::uint64_t> some, hole, at_min, at_max, after_min, before_max;
  std::vector<std::vector<std::uint64_t>> in_range, if_reached;  ///< by crank
  CellRanges ranges, other;
};

/// Feasible cells of a slice.
struct CellTally {
  std::int64_t cells = 0;
  bool touches_box = false;
};

/// Loops over the swept coordinates: the outer one of three, the middle one, and the innermost, along columns.
class CellTest {
 public:
  explicit CellTest(CellPlan plan) : plan_(std::move(plan)) {}

  /// Cells of the outer, the middle and the innermost loop; 1 where there is none.
  std::array<std::size_t, 3> shape(const VoxelGrid& grid) const;
  /// The cell of the grid, by axis, of these three.
  std::array<std::int64_t, 3> cell(std::size_t outer, std::size_t middle, std::size_t inner) const;
  static std::size_t words(std::size_t cells) { return (cells + 63) / 64; }
  /// Whether a column is on the box's outside.
  bool is_outermost(const VoxelGrid& grid, std::size_t outer) const;
  bool at_side(const VoxelGrid& grid, std::size_t outer, std::size_t middle) const;

  /// Computes what no swept coordinate changes.
  /// @param inputs  of the design, with held coordinates
  void start(const std::vector<double>& inputs, CellRoom& room) const;
  /// Finds the cells of a slice, after start().
  /// @param want_bits  whether room.bits is to be set, too
  CellTally test(const VoxelGrid& grid, std::size_t outer, bool want_bits, CellRoom& room) const;

 private:
  /// Columns [first, first + count) of a slice.
  CellTally test_columns(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count, bool want_bits,
                         CellRoom& room) const;
  /// Finds the ranges of columns that their conditions leave. True: with holes in room.hole.
  bool narrow_ranges(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                     CellRoom& room) const;
  CellTally tally_of_ranges(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                            const CellRanges& ranges) const;
  CellTally tally_of_bits(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                          const std::vector<std::uint64_t>& bits) const;
  void find_bits(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                 CellRoom& room) const;
  /// The cells in which one condition holds, of `count` columns.
  void bits_of(const ColumnCondition& condition, const ColumnGrid& column_grid, std::size_t count, CellRoom& room,
               std::vector<std::uint64_t>& bits) const;
  void find_crank_bits(std::size_t crank, const ColumnGrid& column_grid, std::size_t count, CellRoom& room) const;
  void test_cells(const VoxelGrid& grid, std::size_t first, std::size_t column, CellRoom& room) const;

  CellPlan plan_;
};

}  // namespace pkm::generic
