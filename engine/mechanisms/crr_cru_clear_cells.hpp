// (3CRR/R)&CRU and Quadrupteron: voxel surveys under a clearance limit. What reach and slides leave comes in rows of
// bits; of these, cells whose links are too near to each other are taken out one by one.
#pragma once

#include "engine/mechanisms/crr_cru_links.hpp"
#include "engine/mechanisms/crr_cru_voxels.hpp"

namespace pkm::crr_cru {

/// A clearance limit on one design in one working mode: where the elbows are, and so which links meet, depends on it.
struct ClearanceTest {
  Geometry<double> g;
  LinkRadii<double> radii;
  WorkingMode mode;
  double least;  ///< [m]

  /// Whether the links at a pose that assembles keep clear.
  bool passes(const Pose<double>& pose) const { return keep_clear(links(g, radii, inverse(g, pose, mode)), least); }
};

/// VoxelRows::visit_columns, without the cells that do not pass.
/// @param test     none: every cell passes
/// @param pose_of  cell -> pose
template <class PoseOf, class Visit>
void visit_clear_columns(VoxelRows& rows, const Design<double>& d, const Held& held, const VoxelGrid& grid,
                         const std::optional<ClearanceTest>& test, const PoseOf& pose_of, const Visit& visit) {
  if (!test) {
    rows.visit_columns(d, held, grid, visit);
    return;
  }
  const GridAxes axes = grid_axes(held);
  std::vector<std::uint64_t> clear;
  rows.visit_columns(d, held, grid, [&](std::int64_t outer, std::int64_t u, const auto& row) {
    std::array<std::int64_t, 3> cell{};
    cell[axes.outer] = outer;
    cell[axes.u] = u;
    clear.assign(row.size(), 0);
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < row.size(); ++w) {
      for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1) {
        cell[axes.v] = static_cast<std::int64_t>(64 * w) + std::countr_zero(bits);
        if (test->passes(pose_of(cell))) clear[w] |= bits & ~(bits - 1);
      }
      any |= clear[w];
    }
    if (any) visit(outer, u, clear);
  });
}

}  // namespace pkm::crr_cru
