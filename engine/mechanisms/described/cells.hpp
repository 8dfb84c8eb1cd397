// Which cells of a grid are feasible, row by row.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/graph/rows.hpp"
#include "engine/mechanisms/described/evaluation.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm::described {

/// What a worker overwrites.
struct CellRoom {
  std::vector<double> inputs, registers, middle_rows, rows;
  std::vector<std::uint8_t> feasible;  ///< of one slice: middle x innermost
};

/// The conditions of a pose over the swept coordinates: what depends on none of them, on the outer one of three, on the
/// middle one, and on the innermost. Immutable, shared by threads.
class CellTest {
 public:
  /// @param swept  outermost first
  CellTest(const Evaluation& evaluation, const std::vector<int>& swept);

  /// Slices of a grid: the cells of the outer one of three axes, else 1.
  std::size_t slices(const VoxelGrid& grid) const { return swept_ == 3 ? static_cast<std::size_t>(grid.cells[0]) : 1; }
  /// Cells of a slice: of its middle and of its innermost axis, fastest.
  std::array<std::size_t, 2> shape(const VoxelGrid& grid) const {
    const auto cells = [&](std::size_t axis) { return static_cast<std::size_t>(grid.cells[axis]); };
    return {swept_ == 1 ? 1 : cells(swept_ - 2), cells(swept_ - 1)};
  }

  /// Computes what no swept coordinate changes.
  /// @param inputs  of the design, with held coordinates
  void start(const std::vector<double>& inputs, CellRoom& room) const;
  /// Fills room.feasible with the cells of a slice, after start().
  void test(const VoxelGrid& grid, std::size_t slice, CellRoom& room) const;

 private:
  void test_columns(const VoxelGrid& grid, std::size_t first, std::size_t count, CellRoom& room) const;
  void test_column(const VoxelGrid& grid, std::size_t column, CellRoom& room) const;

  std::size_t swept_;
  graph::Program program_;
  std::array<std::size_t, 3> inputs_{};  ///< of the outer, the middle and the innermost coordinate
  std::vector<std::uint32_t> early_, handed_down_;
  std::vector<std::uint32_t> middle_conditions_, inner_conditions_;  ///< registers
  std::optional<graph::RowStage> middle_, inner_;
};

}  // namespace pkm::described
