#include "engine/workspace/largest_cube.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/workspace/voxel_grid.hpp"

namespace pkm {
namespace {

using CellIndex = std::array<std::size_t, 3>;

/// Summed-area table (3-D prefix sums) of the cells that are not good: counts them in any box of cells in constant
/// time.
class BadCellCounts {
 public:
  BadCellCounts(const CellIndex& cells, const std::vector<bool>& good) : cells_(cells) {
    sums_.resize((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
    std::size_t cell = 0;
    for (std::size_t i = 0; i < cells[0]; ++i)
      for (std::size_t j = 0; j < cells[1]; ++j)
        for (std::size_t k = 0; k < cells[2]; ++k, ++cell)
          sums_[node_index(i + 1, j + 1, k + 1)] =
              (good[cell] ? 0 : 1) + sum({i, j + 1, k + 1}) + sum({i + 1, j, k + 1}) + sum({i + 1, j + 1, k}) -
              sum({i, j, k + 1}) - sum({i, j + 1, k}) - sum({i + 1, j, k}) + sum({i, j, k});
  }

  /// Number of bad cells in a box from cell `a` to the cell before `b` in each coordinate.
  std::int64_t within(const CellIndex& a, const CellIndex& b) const {
    return sum(b) - sum({a[0], b[1], b[2]}) - sum({b[0], a[1], b[2]}) - sum({b[0], b[1], a[2]}) +
           sum({a[0], a[1], b[2]}) + sum({a[0], b[1], a[2]}) + sum({b[0], a[1], a[2]}) - sum(a);
  }

 private:
  std::size_t node_index(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k;
  }
  std::int64_t sum(const CellIndex& at) const { return sums_[node_index(at[0], at[1], at[2])]; }

  CellIndex cells_;
  std::vector<std::int64_t> sums_;  ///< at each grid node: bad cells whose indices are all less than those of the node
};

}  // namespace

std::optional<CellCube> largest_cube(const WorkspaceFields& workspace, const std::vector<bool>& good) {
  const VoxelGrid grid = workspace.grid();
  const std::size_t axes = workspace.axes.size();
  CellIndex cells{};
  for (std::size_t a = 0; a < 3; ++a) cells[a] = static_cast<std::size_t>(grid.cells[a]);
  const BadCellCounts bad(cells, good);
  std::vector<double> sides;  // candidates: the whole numbers of cells along each axis
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t k = 1; k <= cells[a]; ++k) sides.push_back(static_cast<double>(k) * grid.step[a]);
  std::ranges::sort(sides);
  const auto fits = [&](const CellIndex& first, double side) {
    CellIndex end = {first[0] + 1, first[1] + 1, first[2] + 1};
    for (std::size_t a = 0; a < axes; ++a) {
      constexpr double kRounding = 1e-9;  // [cells]: smaller excesses of the quotient are rounding errors
      end[a] = first[a] + static_cast<std::size_t>(std::ceil(side / grid.step[a] - kRounding));
      if (end[a] > cells[a]) return false;
    }
    return bad.within(first, end) == 0;
  };
  const auto each_cell = [&cells](const auto& visit) {
    for (CellIndex cell{}; cell[0] < cells[0]; ++cell[0])
      for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
        for (cell[2] = 0; cell[2] < cells[2]; ++cell[2]) visit(cell);
  };
  // Number of candidates for which a cube of good cells exists; if one fits, so do all smaller ones.
  std::size_t found = 0;
  each_cell([&](const CellIndex& cell) {
    while (found < sides.size() && fits(cell, sides[found])) ++found;
  });
  if (found == 0) return {};
  const double side = sides[found - 1];
  std::vector<CellIndex> positions;
  each_cell([&](const CellIndex& cell) {
    if (fits(cell, side)) positions.push_back(cell);
  });
  std::array<double, 3> mean{};
  for (const CellIndex& at : positions)
    for (std::size_t a = 0; a < 3; ++a) mean[a] += static_cast<double>(at[a]) / static_cast<double>(positions.size());
  const auto square_distance = [&](const CellIndex& at) {
    double square = 0;
    for (std::size_t a = 0; a < axes; ++a) square += std::pow((static_cast<double>(at[a]) - mean[a]) * grid.step[a], 2);
    return square;
  };
  return CellCube{side, *std::ranges::min_element(positions, {}, square_distance)};
}

}  // namespace pkm
