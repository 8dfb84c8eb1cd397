// 4PPa-2PaR: voxel surveys from column intervals. Same cells as the plain loop over poses, no loop over z.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/mechanisms/four_ppa_two_par_cells.hpp"
#include "engine/mechanisms/four_ppa_two_par_clearance.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::four_ppa_two_par {

/// Whether a pose of the lower mode is feasible: the plain test of one cell, constraint by constraint.
/// @param y  the plane as given, not mirrored
bool feasible(const Geometry<double>& g, const Limits<double>& l, double x, double y, double z, double sin_theta,
              double cos_theta);

/// The paper's box does not matter to the model; this one holds every feasible pose: x in [0, b],
/// z in [-(l_u + l_d + d), -d], theta in [-pi/2, pi/2].
Box default_box(const Geometry<double>& g);

/// Counts cells of grids with a fixed number of cells.
class VoxelCounter {
 public:
  /// @param cells    of x, z, theta
  /// @param theta    range of theta [rad], the same for every design
  VoxelCounter(const std::array<std::int64_t, 3>& cells, const std::array<double, 2>& theta);

  /// Feasible cells of a grid (its cells and theta range as given above) on the plane y.
  /// @param test     what a clearance limit leaves to be tested pose by pose, or null
  /// @param touches  set when a feasible cell lies on the grid's outer layer
  std::int64_t count(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest* test, double y,
                     const VoxelGrid& grid, bool& touches) const;

  /// Calls visit(i, j_first, j_end, k) for every run [j_first, j_end) of feasible z cells at x index i and theta index
  /// k. There is one run at most, unless `test` cuts it.
  template <class Visit>
  void visit_columns(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest* test, double y,
                     const VoxelGrid& grid, const Visit& visit) const {
    ColumnBlock block;
    for (std::int64_t k_block = 0; k_block < cells_[2]; k_block += kLanes) {
      fill_block(g, l, y, grid, k_block, block);
      for (std::int64_t k = k_block; k < std::min(k_block + kLanes, cells_[2]); ++k)
        for (std::int64_t i = block.x_begin; i < block.x_end; ++i) {
          const auto at = static_cast<std::size_t>(i * kLanes + k - k_block);
          if (!(block.first[at] < block.end[at])) continue;
          const auto first = static_cast<std::int64_t>(block.first[at]), end = static_cast<std::int64_t>(block.end[at]);
          if (test)
            visit_clear_runs(g, *test, grid, i, first, end, k, visit);
          else
            visit(i, first, end, k);
        }
    }
  }

  double sin_theta(std::int64_t k) const { return sin_[static_cast<std::size_t>(k)]; }
  double cos_theta(std::int64_t k) const { return cos_[static_cast<std::size_t>(k)]; }

 private:
  /// The runs of one column's cells [first, end) that pass the test, cell by cell.
  template <class Visit>
  void visit_clear_runs(const Geometry<double>& g, const ClearanceTest& test, const VoxelGrid& grid, std::int64_t i,
                        std::int64_t first, std::int64_t end, std::int64_t k, const Visit& visit) const {
    const double x = grid.centre(0, i);
    std::int64_t start = first;
    for (std::int64_t j = first; j < end; ++j) {
      const auto p = lower_placement(g, x, grid.centre(1, j), sin_theta(k), cos_theta(k));
      if (test.excess(p) >= 0) continue;
      if (start < j) visit(i, start, j, k);
      start = j + 1;
    }
    if (start < end) visit(i, start, end, k);
  }
  std::int64_t count_clear(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest& test, double y,
                           const VoxelGrid& grid, bool& touches) const;
  void fill_block(const Geometry<double>& g, const Limits<double>& l, double y, const VoxelGrid& grid,
                  std::int64_t k_block, ColumnBlock& block) const;
  ColumnsAtThetas columns(const Geometry<double>& g, const Limits<double>& l, double y, const VoxelGrid& grid,
                          std::int64_t k_block, std::int64_t thetas, std::int64_t xs) const;

  std::array<std::int64_t, 3> cells_;
  std::vector<double> sin_, cos_;  ///< of every theta, filled up to a whole block
  bool even_;                      ///< the theta grid is symmetric about 0
};

}  // namespace pkm::four_ppa_two_par
