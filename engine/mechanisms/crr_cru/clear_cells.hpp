// (3CRR/R)&CRU and Quadrupteron: voxel surveys under a clearance limit. What reach and slides leave comes in rows of
// bits; of these, cells whose links are too near to each other are taken out one by one.
#pragma once

#include "engine/mechanisms/crr_cru/links.hpp"
#include "engine/mechanisms/crr_cru/voxels.hpp"

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

/// Takes out of a column, a row of bits, the cells that do not pass.
/// @param cell     any of the column
/// @param along    the axis of the column
/// @param pose_of  cell -> pose
/// @return         whether any are left
template <class PoseOf>
bool clear_cells(const ClearanceTest& test, std::array<std::int64_t, 3> cell, std::size_t along, const PoseOf& pose_of,
                 std::vector<std::uint64_t>& row) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < row.size(); ++w) {
    for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1) {
      cell[along] = static_cast<std::int64_t>(64 * w) + std::countr_zero(bits);
      if (!test.passes(pose_of(cell))) row[w] &= ~(bits & ~(bits - 1));
    }
    any |= row[w];
  }
  return any != 0;
}

}  // namespace pkm::crr_cru
