// 4PPa-2PaR: voxel surveys from column intervals. Same cells as the plain loop over poses, no loop over z.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/cells.hpp"
#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"
#include "engine/workspace/cell_runs.hpp"

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
  int images(std::int64_t i, std::int64_t k) const {
    return (mirrored_x && !(centre_x && i == xs - 1) ? 2 : 1) *
           (mirrored_theta && !(centre_theta && k == thetas - 1) ? 2 : 1);
  }
};

/// What a survey's threads overwrite, each for itself.
struct VoxelWorker {
  ColumnBlock columns;
  ColumnConditioning<double> poses;
  std::vector<double> inertia;  ///< values of a pose's fields
};

/// Counts cells of grids with a fixed number of cells.
class VoxelCounter {
 public:
  /// @param cells    of x, z, theta
  /// @param theta    range of theta [rad], the same for every design
  VoxelCounter(const std::array<std::int64_t, 3>& cells, const std::array<double, 2>& theta);

  Halves halves(const VoxelPlane& plane) const;
  Halves whole() const { return {.xs = cells_[0], .thetas = cells_[2]}; }

  /// How many blocks of neighbouring thetas there are.
  std::size_t blocks(const Halves& part) const { return static_cast<std::size_t>((part.thetas + kLanes - 1) / kLanes); }
  /// The same in pieces that are counted at once: a microsecond's work, to be shared out.
  std::size_t pieces(const Halves& part) const { return blocks(part) * static_cast<std::size_t>(parts()); }

  /// Adds the feasible cells that a piece stands for, whatever the plane's test.
  void count(const VoxelPlane& plane, const Halves& part, std::size_t piece, Survey<double>& to) const;

  /// Calls visit(run) for every run of feasible z cells of one block, in the order of theta and x. There is one run at
  /// most at an x, unless the plane's test cuts it.
  template <class Visit>
  void visit_block(const VoxelPlane& plane, std::size_t block, const Halves& part, ColumnBlock& columns,
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
          keep_cells(run, is_clear, visit);
        else
          visit(run);
      }
  }

  double sin_theta(std::int64_t k) const { return sin_[static_cast<std::size_t>(k)]; }
  double cos_theta(std::int64_t k) const { return cos_[static_cast<std::size_t>(k)]; }

 private:
  static constexpr std::int64_t kColumns = 64;                                  ///< of eight thetas, in a piece
  std::int64_t parts() const { return (cells_[0] + kColumns - 1) / kColumns; }  ///< pieces of a block
  void fill_block(const VoxelPlane& plane, std::int64_t k_block, const Halves& part, ColumnBlock& block) const;
  ColumnsAtThetas columns(const VoxelPlane& plane, std::int64_t k_block, const Halves& part) const;

  std::array<std::int64_t, 3> cells_;
  std::vector<double> sin_, cos_;  ///< of every theta, filled up to a whole block
  bool even_;                      ///< the theta grid is symmetric about 0
};

}  // namespace pkm::four_ppa_two_par
