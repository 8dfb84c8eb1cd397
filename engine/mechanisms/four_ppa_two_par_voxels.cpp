#include "engine/mechanisms/four_ppa_two_par_voxels.hpp"

#include <algorithm>

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
  for (std::int64_t k = 0; k < cells[2]; ++k) {
    const auto [s, c] = sincos(theta[0] + (static_cast<double>(k) + 0.5) * step);
    sin_.push_back(s);
    cos_.push_back(c);
  }
}

Row VoxelCounter::make_row() const {
  const auto n = static_cast<std::size_t>(cells_[0]);
  return {std::vector<std::int32_t>(n), std::vector<std::int32_t>(n)};
}

void VoxelCounter::fill_row(const Geometry<double>& g, const Limits<double>& l, double y, const VoxelGrid& grid,
                            std::int64_t k, std::int64_t columns, Row& row) const {
  const auto n = static_cast<std::size_t>(columns);
  const double s = sin_theta(k), c = cos_theta(k);
  // depth of z_c for each limb: -z_c in [top_j, bottom]
  const double shift = g.a * s / 2;
  double top[2];
  bool none = c < l.cos_theta_min || g.l_u < l.h_min;
  for (int j = 0; j < 2; ++j) {
    const double y_j = j == 0 ? y - shift : y + shift, H = std::fmin(y_j, g.L0 - y_j);
    none = none || H < 0;
    top[j] = std::fmax(g.l_u * l.sin_alpha_min, root_or_zero((g.l_u - H) * (g.l_u + H)));
  }
  if (none) {
    std::fill_n(row.first.begin(), n, 0);
    std::fill_n(row.end.begin(), n, 0);
    return;
  }
  const double bottom = root_or_zero((g.l_u - l.h_min) * (g.l_u + l.h_min));
  const double half = g.a * c / 2, x_min = g.l_d * l.sin_beta_min, x_max = g.l_d * l.sin_beta_max;
  const double parallel = l.sin_par_min * g.l_d * g.l_d, l2 = g.l_d * g.l_d;
  const double per_cell = 1 / grid.step[1], cells = static_cast<double>(cells_[1]);
  const double x_0 = grid.lower[0] + 0.5 * grid.step[0] - half, x_step = grid.step[0], w = g.b - 2 * half;
  const double offset = (-g.d - grid.lower[1]) * per_cell - 0.5;  // z = -d in units of cells from the first centre
  const double top_1 = top[0], top_2 = top[1];
  std::int32_t* const first = row.first.data();
  std::int32_t* const end = row.end.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double x1 = x_0 + static_cast<double>(static_cast<std::int32_t>(i)) * x_step, x2 = w - x1;
    const double u1 = l2 - x1 * x1, u2 = l2 - x2 * x2;
    const double sigma1 = std::sqrt(u1 > 0 ? u1 : 0), sigma2 = std::sqrt(u2 > 0 ? u2 : 0);
    const double least = sigma1 < sigma2 ? sigma1 : sigma2;
    const double high1 = top_1 + sigma1, high2 = top_2 + sigma2;
    const double high = high1 > high2 ? high1 : high2;
    // in cells: the first centre at or above lo, the last at or below hi
    double low_cell = offset - (bottom + least) * per_cell, high_cell = offset - high * per_cell;
    low_cell = low_cell > 0 ? low_cell : 0;
    low_cell = low_cell < cells ? low_cell : cells;
    high_cell = high_cell > -1 ? high_cell : -1;
    high_cell = high_cell < cells - 1 ? high_cell : cells - 1;
    const double lesser = x1 < x2 ? x1 : x2, greater = x1 < x2 ? x2 : x1;
    const bool inside = (lesser >= x_min) & (greater <= x_max) & (x1 * sigma2 + x2 * sigma1 >= parallel);
    first[i] = static_cast<std::int32_t>(cells) - static_cast<std::int32_t>(cells - low_cell);  // ceil
    end[i] = static_cast<std::int32_t>(inside ? high_cell + 1 : 0.0);                           // floor + 1
  }
}

std::int64_t VoxelCounter::count(const Geometry<double>& g, const Limits<double>& l, const ClearanceTest* test,
                                 double y, const VoxelGrid& grid, bool& touches) const {
  if (test) return count_clear(g, l, *test, y, grid, touches);
  thread_local Row row;
  const auto n = static_cast<std::size_t>(cells_[0]);
  row.first.resize(n);
  row.end.resize(n);
  // On the middle plane both limbs have the same stroke: the count is even in theta, and symmetric in x if the box is.
  const bool middle = y == g.L0 / 2;
  const bool half_theta = middle && even_;
  const bool half_x = middle && grid.lower[0] == 0 && grid.upper[0] == g.b;
  const std::int64_t rows = half_theta ? (cells_[2] + 1) / 2 : cells_[2];
  const std::int64_t columns = half_x ? (cells_[0] + 1) / 2 : cells_[0];
  const auto top = static_cast<std::int32_t>(cells_[1]);
  std::int64_t total = 0;
  touches = false;
  for (std::int64_t k = 0; k < rows; ++k) {
    fill_row(g, l, y, grid, k, columns, row);
    std::int64_t sum = 0;  // of a large grid, a row alone may exceed 32 bits
    std::int32_t lowest = top, highest = 0;
    for (std::int64_t i = 0; i < columns; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::int32_t cells = row.end[at] - row.first[at];
      sum += cells > 0 ? cells : 0;
      lowest = cells > 0 && row.first[at] < lowest ? row.first[at] : lowest;
      highest = cells > 0 && row.end[at] > highest ? row.end[at] : highest;
    }
    const auto some = [&](std::int64_t i) {
      const auto at = static_cast<std::size_t>(i);
      return row.end[at] > row.first[at];
    };
    if (sum > 0)
      touches = touches || k == 0 || k == cells_[2] - 1 || lowest == 0 || highest == top || some(0) ||
                (!half_x && some(columns - 1));
    if (half_x) {
      const auto last = static_cast<std::size_t>(columns - 1);
      const std::int32_t centre = cells_[0] % 2 == 1 ? std::max(0, row.end[last] - row.first[last]) : 0;
      sum = 2 * sum - centre;
    }
    const bool centre_row = half_theta && cells_[2] % 2 == 1 && k == rows - 1;
    total += half_theta && !centre_row ? 2 * sum : sum;
  }
  return total;
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
