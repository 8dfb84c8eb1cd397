#include "engine/mechanisms/four_ppa_two_par/voxels.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

namespace pkm::four_ppa_two_par {

bool feasible(const Geometry<double>& g, const Limits<double>& l, double x, double y, double z, double sin_theta,
              double cos_theta) {
  if (cos_theta < l.cos_theta_min) return false;
  const double half = g.a * cos_theta / 2, shift = g.a * sin_theta / 2;
  const double x_j[2] = {x - half, g.b - x - half}, y_j[2] = {y - shift, y + shift};
  double sin_b[2], cos_b[2];
  for (int j = 0; j < 2; ++j) {
    if (x_j[j] < 0 || x_j[j] > g.l_d) return false;  // branch, eq 12
    const double sigma = std::sqrt((g.l_d - x_j[j]) * (g.l_d + x_j[j]));
    sin_b[j] = x_j[j] / g.l_d;
    cos_b[j] = sigma / g.l_d;
    if (x_j[j] < g.l_d * l.sin_beta_min || x_j[j] > g.l_d * l.sin_beta_max) return false;  // eqs 17, 20
    const double z_c = z + g.d + sigma;
    if (z_c < -g.l_u || z_c > 0) return false;         // branch, eq 12
    if (-z_c < g.l_u * l.sin_alpha_min) return false;  // eq 17
    const double h = std::sqrt((g.l_u - z_c) * (g.l_u + z_c));
    if (h < l.h_min) return false;                          // eq 19
    if (y_j[j] - h < 0 || y_j[j] + h > g.L0) return false;  // stroke
  }
  if (sin_b[0] * cos_b[1] + cos_b[0] * sin_b[1] < l.sin_par_min) return false;  // eq 15
  if (!l.clearance_min) return true;
  return nearest_links(links(g, lower_placement(g, x, z, sin_theta, cos_theta))).clearance >= *l.clearance_min;
}

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

Halves VoxelCounter::halves(const Geometry<double>& g, double y, const VoxelGrid& grid) const {
  const bool middle = y == g.L0 / 2, theta = middle && even_;
  const bool x = middle && grid.lower[0] == 0 && grid.upper[0] == g.b;
  return {x ? (cells_[0] + 1) / 2 : cells_[0],
          theta ? (cells_[2] + 1) / 2 : cells_[2],
          x,
          theta,
          cells_[0] % 2 == 1,
          cells_[2] % 2 == 1};
}

ColumnsAtThetas VoxelCounter::columns(const Geometry<double>& g, const Limits<double>& l, double y,
                                      const VoxelGrid& grid, std::int64_t k_block, const Halves& part) const {
  const auto k = static_cast<std::size_t>(k_block);
  return {g.a,
          g.b,
          g.l_u,
          g.l_d,
          g.d,
          g.L0,
          l.sin_alpha_min,
          l.sin_beta_min,
          l.sin_beta_max,
          l.sin_par_min,
          l.cos_theta_min,
          l.h_min,
          y,
          grid.lower[0],
          grid.step[0],
          grid.lower[1],
          grid.step[1],
          static_cast<double>(grid.cells[1]),
          &sin_[k],
          &cos_[k],
          part.thetas - k_block,
          part.xs};
}

void VoxelCounter::fill_block(const Geometry<double>& g, const Limits<double>& l, double y, const VoxelGrid& grid,
                              std::int64_t k_block, const Halves& part, ColumnBlock& block) const {
  block.first.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  block.end.resize(static_cast<std::size_t>(cells_[0] * kLanes));
  const ColumnsAtThetas at = columns(g, l, y, grid, k_block, part);
  with_instruction_set([&]<InstructionSet set>() { fill<set>(at, block); });
}

std::int64_t VoxelCounter::count(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest* test,
                                 double y, const VoxelGrid& grid, bool& touches) const {
  if (test) return count_clear(g, l, *test, y, grid, touches);
  constexpr std::int64_t kColumns = 64;  // of eight thetas: a microsecond's work, to be shared out
  const Halves part = halves(g, y, grid);
  thread_local std::vector<CellTally> tallies;
  std::vector<CellTally>& found = tallies;                         // this thread's, also for the others of the team
  const std::int64_t parts = (part.xs + kColumns - 1) / kColumns;  // of each block
  found.resize(blocks(part) * static_cast<std::size_t>(parts));
  const auto block_of = [&](std::size_t piece) { return static_cast<std::int64_t>(piece) / parts * kLanes; };
  share_pieces(found.size(), [&](std::size_t piece, std::size_t end) {
    for (; piece < end; ++piece) {
      const ColumnsAtThetas at = columns(g, l, y, grid, block_of(piece), part);
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

std::int64_t VoxelCounter::count_clear(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest& test,
                                       double y, const VoxelGrid& grid, bool& touches) const {
  std::int64_t total = 0;
  touches = false;
  visit_columns(g, l, &test, y, grid, [&](std::int64_t i, std::int64_t first, std::int64_t end, std::int64_t k) {
    total += end - first;
    touches = touches || i == 0 || i == cells_[0] - 1 || first == 0 || end == cells_[1] || k == 0 || k == cells_[2] - 1;
  });
  return total;
}

}  // namespace pkm::four_ppa_two_par
