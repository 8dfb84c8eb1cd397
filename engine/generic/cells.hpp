// Feasible cells of a voxel grid. Columns along the innermost coordinate are bounded in closed form by the constraints
// that are quadratic along it; their cells are counted, not tested. The remaining constraints are tested for the cells
// of these columns in SIMD batches.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/generic/cell_plan.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::generic {

/// Scratch memory of CellTest. Each set of cells is stored with one bit per cell, in CellTest::words() words per
/// column.
struct CellScratch {
  std::vector<double> registers;
  expression::Rows middle_rows, rows;
  std::vector<std::uint64_t> bits;  ///< bit set of the feasible cells of a slice, if it is requested
  std::vector<std::uint64_t> any, hole, at_min, at_max, after_min, before_max;
  /// Bit sets for each crank. in_range: cells whose crank angle is in its range. if_reached: cells whose crank angle is
  /// in its range, provided that the limb reaches them.
  std::vector<std::vector<std::uint64_t>> in_range, if_reached;
  CellRanges ranges, other;
};

/// Number of feasible cells of a slice or of some of its columns.
struct CellTally {
  std::int64_t cells = 0;
  bool touches_box = false;  ///< true: a feasible cell lies at the border of the grid
};

/// Finds the feasible cells of a grid, slice by slice. The three coordinates are swept by nested loops: a slice
/// consists of the cells of one iteration of the outer loop, a column of those of one iteration of the middle loop.
class CellTest {
 public:
  explicit CellTest(CellPlan plan) : plan_(std::move(plan)) {}

  /// Number of cells of the outer, middle and inner loop; 1 for a loop that does not exist.
  std::array<std::size_t, 3> shape(const VoxelGrid& grid) const;
  /// Converts the indices of a cell in the three loops to its indices along the axes of the grid.
  std::array<std::int64_t, 3> cell(std::size_t outer, std::size_t middle, std::size_t inner) const;
  static std::size_t words(std::size_t cells) { return (cells + 63) / 64; }
  /// True if all cells of a slice are at the border of the grid.
  bool is_outermost(const VoxelGrid& grid, std::size_t outer) const;
  /// True if all cells of a column are at the border of the grid.
  bool at_side(const VoxelGrid& grid, std::size_t outer, std::size_t middle) const;

  /// Computes everything that does not depend on the swept coordinates.
  /// @param inputs  values of the graph's inputs, including the fixed coordinates
  void start(const std::vector<double>& inputs, CellScratch& scratch) const;
  /// Finds the feasible cells of a slice, after start().
  /// @param want_bits  whether to compute scratch.bits
  CellTally test(const VoxelGrid& grid, std::size_t outer, bool want_bits, CellScratch& scratch) const;

 private:
  /// Finds the feasible cells of columns [first, first + count) of a slice.
  CellTally test_columns(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count, bool want_bits,
                         CellScratch& scratch) const;
  /// Finds, for each of `count` columns, the range of cells that satisfy plan_.columns.
  /// @return true if some ranges have holes, whose cells are set in scratch.hole
  bool find_ranges(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                   CellScratch& scratch) const;
  CellTally tally_of_ranges(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                            const CellRanges& ranges) const;
  CellTally tally_of_bits(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                          const std::vector<std::uint64_t>& bits) const;
  /// Clears the bits of those cells that violate a clause (CellPlan::disjunctions), the range of a crank or a
  /// constraint of the inner loop.
  void clear_bits(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                  CellScratch& scratch) const;
  /// Finds the cells of `count` columns that satisfy one constraint.
  void bits_of(const ColumnConstraint& constraint, const ColumnGrid& column_grid, std::size_t count,
               CellScratch& scratch, std::vector<std::uint64_t>& bits) const;
  /// Computes scratch.in_range[crank] and scratch.if_reached[crank], sets of cells in the range of a crank, for the
  /// cells of `count` columns.
  void find_crank_bits(std::size_t crank, const ColumnGrid& column_grid, std::size_t count, CellScratch& scratch) const;
  /// Tests the constraints of the inner loop in those cells of the column with index first + column whose bit is set,
  /// and clears the bits of infeasible cells.
  void test_cells(const VoxelGrid& grid, std::size_t first, std::size_t column, CellScratch& scratch) const;

  CellPlan plan_;
};

}  // namespace pkm::generic
