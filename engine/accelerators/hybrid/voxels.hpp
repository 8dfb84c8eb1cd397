// Hybrid robot: voxels over (x, z, beta). At given z and beta the feasible x form an interval, possibly with a hole
// (slice.hpp), whose cells are counted by its endpoints.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/accelerators/hybrid/cells.hpp"
#include "engine/accelerators/hybrid/slice.hpp"
#include "engine/workspace/cell_runs.hpp"
#include "engine/workspace/grid_evaluator.hpp"

namespace pkm::hybrid {

/// A box in x, z, beta that contains every feasible pose. If no pose is feasible, it is arbitrary.
Box default_box(const SlicedDesign<double>& d);

/// Quantities that depend on z only, followed by kLanes unused elements, which kernels may read.
struct VoxelHeights {
  std::vector<double> z, left, right;  ///< each z, and the range of x that limbs A and B allow there [m]

  void fill(const SlicedDesign<double>& d, const VoxelGrid& grid);
};

/// A design on its grid, which is evaluated column by column along x.
struct VoxelColumns : GriddedDesign {
  SlicedDesign<double> design;
  const VoxelHeights& heights;  ///< quantities that depend on z only, for this design and grid

  /// Number of feasible cells at beta number k.
  /// @param runs     scratch memory
  /// @param touches  set to true if a feasible cell is at a boundary of the box; otherwise unchanged
  std::int64_t count(std::int64_t k, CellRuns& runs, bool& touches) const;

  /// Calls visit(run) for every run of feasible cells along x at beta number k.
  /// @param runs  scratch memory
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
  /// The columns along x at one beta.
  struct Columns {
    std::size_t first_z = 0, end_z = 0;
    CellTally tally{0, false};
  };
  Columns find_runs(std::int64_t k, CellRuns& runs) const;
};

}  // namespace pkm::hybrid
