// Hybrid robot: voxels over (x, z, beta). At given z and beta the feasible x are an interval less another one
// (section.hpp), so cells are counted by its ends, with no loop over x.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/mechanisms/hybrid/cells.hpp"
#include "engine/mechanisms/hybrid/conditioning.hpp"
#include "engine/mechanisms/hybrid/section.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm::hybrid {

/// The design whose cells are counted.
struct VoxelDesign {
  Frame<double> frame;
  bool with_links = false;  ///< they keep their clearance as capsules; else they are left out
};

/// A box that contains every feasible pose, as x, z, beta; where there is none, a box of some size.
Box default_box(const VoxelDesign& design);

/// What all columns at a height have in common.
struct VoxelHeights {
  std::vector<double> z, left, right;  ///< heights, and what limbs A and B leave of x there [m]
};

/// Storage that surveys reuse.
struct VoxelScratch {
  struct Worker {
    PoseList poses;  ///< whose conditioning is asked for
    CellRuns runs;   ///< at one beta
  };
  VoxelHeights heights;
  std::vector<Worker> workers;
};

/// The feasible cells of a grid, column by column along x. Threads may share it.
class VoxelColumns {
 public:
  /// @param design, grid, heights  stay alive
  VoxelColumns(const VoxelDesign& design, const VoxelGrid& grid, VoxelHeights& heights);

  /// Cells at beta number k, whatever the clearance.
  /// @param runs     overwritten
  /// @param touches  set if some of them are at a side of the box
  std::int64_t count(std::int64_t k, CellRuns& runs, bool& touches) const;

  /// Calls visit(i, i_end, j) for every run [i, i_end) of feasible cells along x at beta number k.
  /// @param runs  overwritten
  template <class Visit>
  void visit(std::int64_t k, CellRuns& runs, const Visit& visit) const {
    const Columns at = find_runs(k, runs);
    for (std::size_t j = at.first_z; j < at.end_z; ++j)
      for (const auto& [first, end] :
           {std::array{runs.first[j], runs.hole[j]}, std::array{runs.after[j], runs.end[j]}}) {
        const auto from = static_cast<std::int64_t>(first), to = static_cast<std::int64_t>(end),
                   height = static_cast<std::int64_t>(j);
        if (!(from < to)) continue;
        if (design_.with_links)
          visit_clear(from, to, height, k, visit);
        else
          visit(from, to, height);
      }
  }

 private:
  /// The columns at one beta.
  struct Columns {
    std::size_t first_z = 0, end_z = 0;
    CellTally tally{0, false};
  };
  Columns find_runs(std::int64_t k, CellRuns& runs) const;
  /// The links' pairs whose distance changes along x, or those where it doesn't, keep clear.
  bool clear(double x, double z, double beta, bool along_x) const;

  template <class Visit>
  void visit_clear(std::int64_t from, std::int64_t to, std::int64_t j, std::int64_t k, const Visit& visit) const {
    const double z = grid_.centre(1, j), beta = grid_.centre(2, k);
    if (!clear(grid_.centre(0, from), z, beta, false)) return;
    std::int64_t start = from;
    for (std::int64_t i = from; i < to; ++i) {
      if (clear(grid_.centre(0, i), z, beta, true)) continue;
      if (start < i) visit(start, i, j);
      start = i + 1;
    }
    if (start < to) visit(start, to, j);
  }

  const VoxelDesign& design_;
  const VoxelGrid& grid_;
  const VoxelHeights& heights_;
};

}  // namespace pkm::hybrid
