// Hybrid robot: voxels over (x, z, beta). At given z and beta the feasible x are an interval less another one
// (hybrid_section.hpp), so cells are counted by its ends, with no loop over x.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/mechanisms/hybrid_cells.hpp"
#include "engine/mechanisms/hybrid_section.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::hybrid {

/// The design whose cells are counted.
struct VoxelDesign {
  Frame<double> frame;
  int branch = 1;                   ///< required sign of N2
  std::optional<double> clearance;  ///< least distance of the links as capsules [m]; none: they are left out
};

/// Whether a pose is feasible: every margin of section 7 of the document, stroke 2 apart, and the clearance asked for.
bool feasible(const VoxelDesign& design, double x, double z, double beta);

/// A box that contains every feasible pose, as x, z, beta; where there is none, a box of some size.
Box default_box(const VoxelDesign& design);

/// Storage that surveys reuse.
struct VoxelScratch {
  std::vector<double> z, left, right;  ///< heights, and what limbs A and B leave of x there [m]
  CellRuns runs;
};

/// The feasible cells of a grid, column by column along x.
class VoxelColumns {
 public:
  /// @param design, grid, scratch  stay alive
  VoxelColumns(const VoxelDesign& design, const VoxelGrid& grid, VoxelScratch& scratch);

  /// Cells at beta number k, whatever the clearance.
  /// @param touches  set if some of them are at a side of the box
  std::int64_t count(std::int64_t k, bool& touches);

  /// Calls visit(i, i_end, j, k) for every run [i, i_end) of feasible cells along x.
  template <class Visit>
  void visit(const Visit& visit) {
    for (std::int64_t k = 0; k < grid_.cells[2]; ++k) {
      find_runs(k);
      const CellRuns& r = found_.runs;
      for (std::size_t j = first_z_; j < end_z_; ++j)
        for (const auto& [first, end] : {std::array{r.first[j], r.hole[j]}, std::array{r.after[j], r.end[j]}}) {
          const auto from = static_cast<std::int64_t>(first), to = static_cast<std::int64_t>(end),
                     height = static_cast<std::int64_t>(j);
          if (!(from < to)) continue;
          if (design_.clearance)
            visit_clear(from, to, height, k, visit);
          else
            visit(from, to, height, k);
        }
    }
  }

 private:
  /// Finds the columns at beta number k.
  CellTally find_runs(std::int64_t k);
  /// The links' pairs whose distance changes along x, or those where it doesn't, keep clear.
  bool clear(double x, double z, double beta, bool along_x) const;

  template <class Visit>
  void visit_clear(std::int64_t from, std::int64_t to, std::int64_t j, std::int64_t k, const Visit& visit) const {
    const double z = grid_.centre(1, j), beta = grid_.centre(2, k);
    if (!clear(grid_.centre(0, from), z, beta, false)) return;
    std::int64_t start = from;
    for (std::int64_t i = from; i < to; ++i) {
      if (clear(grid_.centre(0, i), z, beta, true)) continue;
      if (start < i) visit(start, i, j, k);
      start = i + 1;
    }
    if (start < to) visit(start, to, j, k);
  }

  const VoxelDesign& design_;
  const VoxelGrid& grid_;
  VoxelScratch& found_;
  std::size_t first_z_ = 0, end_z_ = 0;
};

}  // namespace pkm::hybrid
