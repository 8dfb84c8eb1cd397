#include "engine/accelerators/four_ppa_two_par/voxels.hpp"

#include <algorithm>

namespace pkm::four_ppa_two_par {

Box default_box(const Geometry<double>& g) { return {{{0, g.b}, {-(g.l_u + g.l_d + g.d), -g.d}, {-kPi / 2, kPi / 2}}}; }

VoxelCounter::VoxelCounter(const std::array<std::int64_t, 3>& cells, const std::array<double, 2>& theta)
    : cells_(cells), even_(theta[0] == -theta[1]) {
  const double step = (theta[1] - theta[0]) / static_cast<double>(cells[2]);
  for (std::int64_t k = 0; k < cells[2] || k % kLanes != 0; ++k) {
    const auto [s, c] = sincos(theta[0] + (static_cast<double>(k) + 0.5) * step);
    sin_.push_back(s);
    cos_.push_back(c);
  }
}

GridPart VoxelCounter::representative_part(const VoxelPlane& plane) const {
  const Geometry<double>& g = plane.g;
  const VoxelGrid& grid = plane.grid;
  const bool middle = plane.y == g.L0 / 2, theta = middle && even_;
  const bool x = middle && grid.lower[0] == 0 && grid.upper[0] == g.b;
  return {.xs = x ? (cells_[0] + 1) / 2 : cells_[0],
          .thetas = theta ? (cells_[2] + 1) / 2 : cells_[2],
          .mirrored_x = x,
          .mirrored_theta = theta,
          .centre_x = cells_[0] % 2 == 1,
          .centre_theta = cells_[2] % 2 == 1};
}

ColumnsAtThetas VoxelCounter::columns(const VoxelPlane& plane, std::int64_t k_block, const GridPart& part) const {
  const auto& [g, l, test, y, grid] = plane;
  const auto k = static_cast<std::size_t>(k_block);
  const Ranges<double> in = ranges(g, l);
  return {.a = g.a,
          .b = g.b,
          .l_u = g.l_u,
          .l_d = g.l_d,
          .d = g.d,
          .L0 = g.L0,
          .sin_par_min = l.sin_par_min,
          .cos_theta_min = l.cos_theta_min,
          .x_min = in.x_min,
          .x_max = in.x_max,
          .z_low = in.z_low,
          .z_high = in.z_high,
          .y = y,
          .x_lower = grid.lower[0],
          .x_step = grid.step[0],
          .z_lower = grid.lower[1],
          .z_step = grid.step[1],
          .z_cells = static_cast<double>(grid.cells[1]),
          .sines = &sin_[k],
          .cosines = &cos_[k],
          .thetas = g.l_u >= l.h_min ? part.thetas - k_block : 0,
          .columns = part.xs};
}

void VoxelCounter::fill_block(const VoxelPlane& plane, std::int64_t k_block, const GridPart& part,
                              ColumnBlock& block) const {
  block.first.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  block.end.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  const ColumnsAtThetas at = columns(plane, k_block, part);
  with_instruction_set([&]<InstructionSet set>() { fill<set>(at, block); });
}

void VoxelCounter::count(const VoxelPlane& plane, const GridPart& part, std::size_t tile,
                         WorkspaceResult<double>& to) const {
  const auto n = static_cast<std::int64_t>(tile);
  const std::int64_t k_block = n / tiles_per_block() * kLanes, from = n % tiles_per_block() * kColumns;
  if (k_block >= part.thetas || from >= part.xs) return;
  const ColumnsAtThetas at = columns(plane, k_block, part);
  const CellTally t = with_instruction_set([&]<InstructionSet set>() { return tally<set>(at, from, from + kColumns); });
  double total = 0;  // number of cells; always an integer
  bool touches = t.lowest || t.highest;
  for (std::int64_t k = k_block; k < std::min(k_block + kLanes, part.thetas); ++k) {
    const std::int64_t lane = k - k_block;
    if (t.cells[lane] == 0) continue;
    const double last = t.in_last[lane];
    touches = touches || plane.grid.at_end(2, k) || t.in_first[lane] > 0 || (!part.mirrored_x && last > 0);
    total += (t.cells[lane] - last) * part.images(0, k) + last * part.images(part.xs - 1, k);
  }
  to.feasible_cells += static_cast<std::int64_t>(total);
  to.touches_box = to.touches_box || touches;
}

}  // namespace pkm::four_ppa_two_par
