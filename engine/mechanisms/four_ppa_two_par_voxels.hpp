// 4PPa-2PaR: voxel surveys from column intervals. Same cells as the plain loop over poses, no loop over z.
#pragma once

#include <vector>

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

/// What the feasible cells of one row (fixed theta, all x) are: cells [first, end) of z, per x.
struct Row {
  std::vector<std::int32_t> first, end;
};

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
    Row row = make_row();
    for (std::int64_t k = 0; k < cells_[2]; ++k) {
      fill_row(g, l, y, grid, k, cells_[0], row);
      for (std::int64_t i = 0; i < cells_[0]; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (!(row.first[at] < row.end[at])) continue;
        if (test)
          visit_clear_runs(g, *test, grid, i, row.first[at], row.end[at], k, visit);
        else
          visit(i, row.first[at], row.end[at], k);
      }
    }
  }

  double sin_theta(std::int64_t k) const { return sin_[static_cast<std::size_t>(k)]; }
  double cos_theta(std::int64_t k) const { return cos_[static_cast<std::size_t>(k)]; }

 private:
  Row make_row() const;
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
  /// Fills the first `columns` x of row k.
  void fill_row(const Geometry<double>& g, const Limits<double>& l, double y, const VoxelGrid& grid, std::int64_t k,
                std::int64_t columns, Row& row) const;

  std::array<std::int64_t, 3> cells_;
  std::vector<double> sin_, cos_;
  bool even_;  ///< the theta grid is symmetric about 0
};

}  // namespace pkm::four_ppa_two_par
