#include "engine/mechanisms/crr_cru_voxels.hpp"

#include <algorithm>

namespace pkm::crr_cru {
namespace {

/// Clears bits [first, end).
void clear_bits(std::uint64_t* bits, std::int64_t first, std::int64_t end) {
  if (first >= end) return;
  const auto from = static_cast<std::size_t>(first), to = static_cast<std::size_t>(end);
  const std::uint64_t keep_below = (std::uint64_t{1} << (from % 64)) - 1;
  const std::uint64_t keep_above = to % 64 == 0 ? 0 : ~((std::uint64_t{1} << (to % 64)) - 1);
  const std::size_t a = from / 64, b = (to - 1) / 64;
  if (a == b) {
    bits[a] &= keep_below | keep_above;
    return;
  }
  bits[a] &= keep_below;
  for (std::size_t w = a + 1; w < b; ++w) bits[w] = 0;
  bits[b] &= keep_above;
}

/// Sets bits [0, size) of `words` words and clears the rest.
void set_bits(std::uint64_t* bits, std::size_t words, std::size_t size) {
  std::fill_n(bits, words, ~std::uint64_t{0});
  if (size % 64 != 0) bits[words - 1] = (std::uint64_t{1} << (size % 64)) - 1;
}

}  // namespace

Box default_box(const Design<double>& d, const Held& held) {
  const Geometry<double>& g = d.g;
  const auto [s, c] = sincos(held.coordinate == 3 ? held_value(g, held) : 0.0);
  const auto arm = arms(g, s, c);
  std::array<std::array<double, 2>, 4> range;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool swings = held.coordinate != 3 && arm[k].turns && k < 2;  // by r either way
    const double shift = swings ? 0 : arm[k].to_joint[k], reach = swings ? g.r : 0;
    range[k] = {g.rho_min - shift - reach, g.rho_max - shift + reach};
  }
  const double delta = offset(d.yaw);
  range[3] = {-delta - kPi / 2, kPi / 2 - delta};
  Box box;
  for (std::size_t k = 0, axis = 0; k < 4; ++k)
    if (k != held.coordinate) box[axis++] = range[k];
  return box;
}

void VoxelRows::prepare(const VoxelGrid& grid, const GridAxes& axes) {
  const auto fill = [&grid](Axis& axis, std::size_t which) {
    axis.lower = grid.lower[which];
    axis.step = grid.step[which];
    axis.center.resize(static_cast<std::size_t>(grid.cells[which]));
    for (std::size_t k = 0; k < axis.center.size(); ++k)
      axis.center[k] = grid.centre(which, static_cast<std::int64_t>(k));
  };
  fill(u_, axes.u);
  fill(v_, axes.v);
  words_ = (v_.center.size() + 63) / 64;
  plane_u_.resize((u_.center.size() + 63) / 64);
  plane_v_.resize(words_);
  row_.resize(words_);
  coupled_.resize(u_.center.size() * words_);
}

RingLines VoxelRows::lines_along(const Axis& axis) {
  RingLines lines{axis.lower, axis.step, static_cast<double>(axis.center.size()), {}, {}, {}, {}};
  return lines;
}

/// Clears what lies outside of the ring of one line.
void VoxelRows::cut(const RingCells& cells, std::size_t line, std::size_t size, std::uint64_t* bits) {
  const auto whole = [](double number) { return static_cast<std::int64_t>(number); };
  const std::int64_t first = whole(cells.first[line]), end = whole(cells.end[line]),
                     last = static_cast<std::int64_t>(size);
  if (first >= end) {
    clear_bits(bits, 0, last);
    return;
  }
  clear_bits(bits, 0, first);
  clear_bits(bits, end, last);
  clear_bits(bits, whole(cells.hole_first[line]), whole(cells.hole_end[line]));
}

bool VoxelRows::fill_plane(const Design<double>& d, const Frame<double>& f, const Cuts& c, double at) {
  if (at < f.range[c.normal].lower || at > f.range[c.normal].upper) return false;
  const auto fill = [&](std::size_t coordinate, std::size_t other, const Axis& axis, Bits& bits) {
    const std::size_t size = axis.center.size();
    set_bits(bits.data(), bits.size(), size);
    const auto& range = f.range[coordinate];
    const auto begin = axis.center.begin(), end = axis.center.end();
    clear_bits(bits.data(), 0, std::lower_bound(begin, end, range.lower) - begin);
    clear_bits(bits.data(), std::upper_bound(begin, end, range.upper) - begin, end - begin);
    RingLines lines = lines_along(axis);
    std::size_t rings = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (kPlane[i][0] == other || kPlane[i][1] == other) continue;
      lines.center[rings] = f.center[i][coordinate];
      lines.away[rings] = at - f.center[i][c.normal];
      lines.in2[rings] = d.in2[i];
      lines.out2[rings++] = d.out2[i];
    }
    if (rings > 0) {
      const RingCells cells = with_instruction_set([&]<InstructionSet set>() { return cells_in_rings<set>(lines); });
      for (std::size_t ring = 0; ring < rings; ++ring) cut(cells, ring, size, bits.data());
    }
    return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
  };
  return fill(c.u, c.v, u_, plane_u_) && fill(c.v, c.u, v_, plane_v_);
}

void VoxelRows::fill_coupled(const Design<double>& d, const Frame<double>& f, const Cuts& c) {
  const std::size_t size = v_.center.size(), columns = u_.center.size();
  for (std::size_t j = 0; j < columns; ++j) set_bits(coupled_.data() + j * words_, words_, size);
  RingLines lines = lines_along(v_);
  for (std::size_t i = 0; i < 4; ++i) {
    if (kPlane[i][0] == c.normal || kPlane[i][1] == c.normal) continue;
    std::fill_n(lines.center, kLanes, f.center[i][c.v]);
    std::fill_n(lines.in2, kLanes, d.in2[i]);
    std::fill_n(lines.out2, kLanes, d.out2[i]);
    for (std::size_t j = 0; j < columns; j += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, columns - j);
      for (std::size_t k = 0; k < count; ++k) lines.away[k] = u_.center[j + k] - f.center[i][c.u];
      const RingCells cells = with_instruction_set([&]<InstructionSet set>() { return cells_in_rings<set>(lines); });
      for (std::size_t k = 0; k < count; ++k) cut(cells, k, size, coupled_.data() + (j + k) * words_);
    }
  }
}

}  // namespace pkm::crr_cru
