// Hybrid robot: voxels over (x, z, beta). At given z and beta the feasible x are an interval less another one
// (section.hpp), so cells are counted by its ends, with no loop over x.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accelerators/hybrid/cells.hpp"
#include "engine/accelerators/hybrid/slice.hpp"
#include "engine/workspace/cell_runs.hpp"

namespace pkm::hybrid {

/// A box that contains every feasible pose, as x, z, beta; where there is none, a box of some size.
Box default_box(const Frame<double>& f);

/// What all columns at a height have in common.
struct VoxelHeights {
  std::vector<double> z, left, right;  ///< heights, and what limbs A and B leave of x there [m]

  void fill(const Frame<double>& f, const VoxelGrid& grid);
};

/// The feasible cells of a grid, column by column along x. Threads may share it.
class VoxelColumns {
 public:
  /// @param frame, grid, heights  stay alive; the heights are theirs
  VoxelColumns(const Frame<double>& frame, const VoxelGrid& grid, const VoxelHeights& heights)
      : frame_(frame), grid_(grid), heights_(heights) {}

  /// Cells at beta number k.
  /// @param runs     overwritten
  /// @param touches  set if some of them are at a side of the box
  std::int64_t count(std::int64_t k, CellRuns& runs, bool& touches) const;

  /// Calls visit(run) for every run of feasible cells along x at beta number k.
  /// @param runs  overwritten
  template <class Visit>
  void visit(std::int64_t k, CellRuns& runs, const Visit& visit) const {
    const Columns at = find_runs(k, runs);
    for (std::size_t j = at.first_z; j < at.end_z; ++j)
      for (const auto& [first, end] :
           {std::array{runs.first[j], runs.hole[j]}, std::array{runs.after[j], runs.end[j]}}) {
        const CellRun run{
            {static_cast<std::int64_t>(first), static_cast<std::int64_t>(j), k}, 0, static_cast<std::int64_t>(end)};
        if (run.count() > 0) visit(run);
      }
  }

 private:
  /// The columns at one beta.
  struct Columns {
    std::size_t first_z = 0, end_z = 0;
    CellTally tally{0, false};
  };
  Columns find_runs(std::int64_t k, CellRuns& runs) const;

  const Frame<double>& frame_;
  const VoxelGrid& grid_;
  const VoxelHeights& heights_;
};

}  // namespace pkm::hybrid
