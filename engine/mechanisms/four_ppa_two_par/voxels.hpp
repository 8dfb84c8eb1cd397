// 4PPa-2PaR: voxel surveys from column intervals. Same cells as the plain loop over poses, no loop over z.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/mechanisms/four_ppa_two_par/cells.hpp"
#include "engine/mechanisms/four_ppa_two_par/clearance.hpp"
#include "engine/mechanisms/four_ppa_two_par/conditioning.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm::four_ppa_two_par {

/// The paper's box does not matter to the model; this one holds every feasible pose: x in [0, b],
/// z in [-(l_u + l_d + d), -d], theta in [-pi/2, pi/2].
Box default_box(const Geometry<double>& g);

/// A plane of one design and the grid on it.
struct VoxelPlane {
  const Geometry<double>& g;
  const Limits<double>& l;
  const ClearanceTest* test;  ///< what a clearance limit leaves to be tested pose by pose, or null
  double y;                   ///< as given, not mirrored
  const VoxelGrid& grid;      ///< its cells and theta range are the counter's
};

/// The part of a grid that has all: on the middle plane both limbs have the same stroke, so that what is feasible is
/// even in theta where the grid is, and symmetric in x where the box is.
struct Halves {
  std::int64_t xs, thetas;  ///< from the first
  bool mirrored_x = false, mirrored_theta = false;
  bool centre_x = false, centre_theta = false;  ///< the last one is its own image

  /// How many columns the one at x index i and theta index k stands for.
  double images(std::int64_t i, std::int64_t k) const {
    return (mirrored_x && !(centre_x && i == xs - 1) ? 2 : 1) *
           (mirrored_theta && !(centre_theta && k == thetas - 1) ? 2 : 1);
  }
};

/// What a survey's threads need, each for itself.
struct VoxelWorker {
  ColumnBlock columns;
  ColumnConditioning<double> poses;
  std::vector<double> inertia;  ///< values of a pose's fields
};
/// Storage that surveys reuse.
struct VoxelScratch {
  std::vector<CellTally> tallies;
  std::vector<VoxelWorker> workers;
};

/// Counts cells of grids with a fixed number of cells.
class VoxelCounter {
 public:
  /// @param cells    of x, z, theta
  /// @param theta    range of theta [rad], the same for every design
  VoxelCounter(const std::array<std::int64_t, 3>& cells, const std::array<double, 2>& theta);

  /// Feasible cells of a plane.
  /// @param touches  set when a feasible cell lies on the grid's outer layer
  std::int64_t count(const VoxelPlane& plane, VoxelScratch& scratch, bool& touches) const;

  Halves halves(const VoxelPlane& plane) const;
  Halves whole() const { return {.xs = cells_[0], .thetas = cells_[2]}; }
  /// How many blocks of neighbouring thetas there are.
  std::size_t blocks(const Halves& part) const { return static_cast<std::size_t>((part.thetas + kLanes - 1) / kLanes); }

  /// Calls visit(i, j_first, j_end, k) for every run [j_first, j_end) of feasible z cells at x index i and theta index
  /// k of one block. There is one run at most, unless the plane's test cuts it.
  template <class Visit>
  void visit_block(const VoxelPlane& plane, std::size_t block, const Halves& part, ColumnBlock& columns,
                   const Visit& visit) const {
    const auto k_block = static_cast<std::int64_t>(block) * kLanes;
    fill_block(plane, k_block, part, columns);
    for (std::int64_t k = k_block; k < std::min(k_block + kLanes, part.thetas); ++k)
      for (std::int64_t i = columns.x_begin; i < columns.x_end; ++i) {
        const auto at = static_cast<std::size_t>(i * kLanes + k - k_block);
        const auto first = static_cast<std::int64_t>(columns.first[at]),
                   end = static_cast<std::int64_t>(columns.end[at]);
        if (!(first < end)) continue;
        if (plane.test)
          visit_clear_runs(plane, i, first, end, k, visit);
        else
          visit(i, first, end, k);
      }
  }
  /// The same for the whole grid.
  template <class Visit>
  void visit_columns(const VoxelPlane& plane, ColumnBlock& columns, const Visit& visit) const {
    const Halves all = whole();
    for (std::size_t block = 0; block < blocks(all); ++block) visit_block(plane, block, all, columns, visit);
  }

  double sin_theta(std::int64_t k) const { return sin_[static_cast<std::size_t>(k)]; }
  double cos_theta(std::int64_t k) const { return cos_[static_cast<std::size_t>(k)]; }

 private:
  /// The runs of one column's cells [first, end) that pass the test, cell by cell.
  template <class Visit>
  void visit_clear_runs(const VoxelPlane& plane, std::int64_t i, std::int64_t first, std::int64_t end, std::int64_t k,
                        const Visit& visit) const {
    const double x = plane.grid.centre(0, i);
    std::int64_t start = first;
    for (std::int64_t j = first; j < end; ++j) {
      const auto p = lower_placement(plane.g, x, plane.grid.centre(1, j), sin_theta(k), cos_theta(k));
      if (plane.test->excess(p) >= 0) continue;
      if (start < j) visit(i, start, j, k);
      start = j + 1;
    }
    if (start < end) visit(i, start, end, k);
  }
  std::int64_t count_clear(const VoxelPlane& plane, ColumnBlock& columns, bool& touches) const;
  void fill_block(const VoxelPlane& plane, std::int64_t k_block, const Halves& part, ColumnBlock& block) const;
  ColumnsAtThetas columns(const VoxelPlane& plane, std::int64_t k_block, const Halves& part) const;

  std::array<std::int64_t, 3> cells_;
  std::vector<double> sin_, cos_;  ///< of every theta, filled up to a whole block
  bool even_;                      ///< the theta grid is symmetric about 0
};

}  // namespace pkm::four_ppa_two_par
