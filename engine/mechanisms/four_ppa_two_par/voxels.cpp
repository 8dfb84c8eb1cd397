#include "engine/mechanisms/four_ppa_two_par/voxels.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

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

Halves VoxelCounter::halves(const VoxelPlane& plane) const {
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

ColumnsAtThetas VoxelCounter::columns(const VoxelPlane& plane, std::int64_t k_block, const Halves& part) const {
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

void VoxelCounter::fill_block(const VoxelPlane& plane, std::int64_t k_block, const Halves& part,
                              ColumnBlock& block) const {
  block.first.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  block.end.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  const ColumnsAtThetas at = columns(plane, k_block, part);
  with_instruction_set([&]<InstructionSet set>() { fill<set>(at, block); });
}

std::int64_t VoxelCounter::count(const VoxelPlane& plane, VoxelScratch& scratch, bool& touches) const {
  scratch.workers.resize(std::max(scratch.workers.size(), workers()));
  if (plane.test) return count_clear(plane, scratch.workers[0].columns, touches);
  constexpr std::int64_t kColumns = 64;  // of eight thetas: a microsecond's work, to be shared out
  const Halves part = halves(plane);
  std::vector<CellTally>& found = scratch.tallies;
  const std::int64_t parts = (part.xs + kColumns - 1) / kColumns;  // of each block
  found.resize(blocks(part) * static_cast<std::size_t>(parts));
  const auto block_of = [&](std::size_t piece) { return static_cast<std::int64_t>(piece) / parts * kLanes; };
  share_pieces(found.size(), [&](std::size_t piece, std::size_t end) {
    for (; piece < end; ++piece) {
      const ColumnsAtThetas at = columns(plane, block_of(piece), part);
      const std::int64_t from = static_cast<std::int64_t>(piece) % parts * kColumns;
      found[piece] = with_instruction_set([&]<InstructionSet set>() { return tally<set>(at, from, from + kColumns); });
    }
  });
  double total = 0;  // whole numbers
  touches = false;
  for (std::size_t piece = 0; piece < found.size(); ++piece) {
    const CellTally& t = found[piece];
    const std::int64_t k_block = block_of(piece);
    for (std::int64_t k = k_block; k < std::min(k_block + kLanes, part.thetas); ++k) {
      const std::int64_t lane = k - k_block;
      if (t.cells[lane] == 0) continue;
      const double last = t.in_last[lane];
      touches = touches || k == 0 || k == cells_[2] - 1 || t.in_first[lane] > 0 || (!part.mirrored_x && last > 0);
      total += (t.cells[lane] - last) * part.images(0, k) + last * part.images(part.xs - 1, k);
    }
    touches = touches || t.lowest || t.highest;
  }
  return static_cast<std::int64_t>(total);
}

std::int64_t VoxelCounter::count_clear(const VoxelPlane& plane, ColumnBlock& columns, bool& touches) const {
  std::int64_t total = 0;
  touches = false;
  visit_columns(plane, columns, [&](std::int64_t i, std::int64_t first, std::int64_t end, std::int64_t k) {
    total += end - first;
    touches = touches || i == 0 || i == cells_[0] - 1 || first == 0 || end == cells_[1] || k == 0 || k == cells_[2] - 1;
  });
  return total;
}

}  // namespace pkm::four_ppa_two_par
