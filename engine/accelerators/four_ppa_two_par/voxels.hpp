// 4PPa-2PaR: feasible voxels, column by column. The result is the same as that of testing every pose.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/cells.hpp"
#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"
#include "engine/workspace/cell_runs.hpp"

namespace pkm::four_ppa_two_par {

/// A box that contains every feasible pose: x in [0, b], z in [-(l_u + l_d + d), -d], theta in [-pi/2, pi/2].
Box default_box(const Geometry<double>& g);

/// A plane y = constant of one design, and the voxel grid on it.
struct VoxelPlane {
  const Geometry<double>& g;
  const Limits<double>& l;
  const ClearanceTest* test;  ///< clearance test of poses; null: links may collide
  double y;                   ///< y of the plane as given by the plan, not mirrored to y <= L0/2
  const VoxelGrid& grid;      ///< its numbers of cells and its theta range are those of the VoxelCounter
};

/// The part of a grid that has to be searched; by symmetry, it represents all cells. On the middle plane, y = L0/2,
/// both limbs have the same stroke, so that the workspace is symmetric in theta and in x, although the grid may not be
/// symmetric.
struct GridPart {
  std::int64_t xs, thetas;  ///< numbers of x and of theta values, beginning with the first of the grid
  bool mirrored_x = false, mirrored_theta = false;
  bool centre_x = false, centre_theta = false;  ///< true if the last x (theta) is its own mirror image

  /// Number of columns that the column at x index i and theta index k represents, including itself.
  int images(std::int64_t i, std::int64_t k) const {
    return (mirrored_x && !(centre_x && i == xs - 1) ? 2 : 1) *
           (mirrored_theta && !(centre_theta && k == thetas - 1) ? 2 : 1);
  }
};

/// Scratch memory of one thread that searches a grid for feasible cells.
struct VoxelWorker {
  ColumnBlock columns;
  ColumnConditioning<double> poses;
  std::vector<double> inertia;  ///< values of the inertia fields at a pose
};

/// Finds and counts the feasible cells of grids that have the same numbers of cells and the same range of theta.
class VoxelCounter {
 public:
  /// @param cells    numbers of cells along x, z and theta
  /// @param theta    range of theta [rad], the same for every design
  VoxelCounter(const std::array<std::int64_t, 3>& cells, const std::array<double, 2>& theta);

  GridPart representative_part(const VoxelPlane& plane) const;
  GridPart whole() const { return {.xs = cells_[0], .thetas = cells_[2]}; }

  /// Number of blocks into which the thetas are divided, each of kLanes values.
  std::size_t blocks(const GridPart& part) const {
    return static_cast<std::size_t>((part.thetas + kLanes - 1) / kLanes);
  }
  /// Number of tiles for count(). A tile has kLanes thetas and kColumns values of x, about a microsecond of work.
  std::size_t tiles(const GridPart& part) const { return blocks(part) * static_cast<std::size_t>(tiles_per_block()); }

  /// Adds the feasible cells that a tile represents, without the clearance test.
  void count(const VoxelPlane& plane, const GridPart& part, std::size_t tile, WorkspaceResult<double>& to) const;

  /// Calls visit(run) for every run of feasible cells along z in one block, in the order of theta and x. A column has
  /// at most one run, unless the clearance test divides it.
  template <class Visit>
  void visit_block(const VoxelPlane& plane, std::size_t block, const GridPart& part, ColumnBlock& columns,
                   const Visit& visit) const {
    const auto k_block = static_cast<std::int64_t>(block) * kLanes;
    if (k_block >= part.thetas) return;
    fill_block(plane, k_block, part, columns);
    const auto is_clear = [&](const Cell& cell) {
      const auto& [i, j, k] = cell;
      return plane.test->excess(lower_placement(plane.g, plane.grid.centre(0, i), plane.grid.centre(1, j), sin_theta(k),
                                                cos_theta(k))) >= 0;
    };
    for (std::int64_t k = k_block; k < std::min(k_block + kLanes, part.thetas); ++k)
      for (std::int64_t i = columns.x_begin; i < columns.x_end; ++i) {
        const auto at = static_cast<std::size_t>(i * kLanes + k - k_block);
        const CellRun run{
            {i, static_cast<std::int64_t>(columns.first[at]), k}, 1, static_cast<std::int64_t>(columns.end[at])};
        if (run.count() <= 0) continue;
        if (plane.test)
          filter_run(run, is_clear, visit);
        else
          visit(run);
      }
  }

  double sin_theta(std::int64_t k) const { return sin_[static_cast<std::size_t>(k)]; }
  double cos_theta(std::int64_t k) const { return cos_[static_cast<std::size_t>(k)]; }

 private:
  static constexpr std::int64_t kColumns = 64;  ///< number of x values per tile
  std::int64_t tiles_per_block() const { return (cells_[0] + kColumns - 1) / kColumns; }
  void fill_block(const VoxelPlane& plane, std::int64_t k_block, const GridPart& part, ColumnBlock& block) const;
  ColumnsAtThetas columns(const VoxelPlane& plane, std::int64_t k_block, const GridPart& part) const;

  std::array<std::int64_t, 3> cells_;
  std::vector<double> sin_, cos_;  ///< sine and cosine of every theta, padded to a whole block
  bool even_;                      ///< true if the theta grid is symmetric about 0
};

}  // namespace pkm::four_ppa_two_par
