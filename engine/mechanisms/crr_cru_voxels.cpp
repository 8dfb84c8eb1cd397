#include "engine/mechanisms/crr_cru_voxels.hpp"

#include <algorithm>
#include <cmath>

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

/// Clears the cells outside a ring on a line `away` from its centre. Rounding is monotonic, so the cells that pass
/// distance2 <= out2 are neighbours, and so are those that pass distance2 < in2; the ends of the chords say where to
/// look for their first and last.
void VoxelRows::cut_ring(const Axis& axis, double center, double away, double in2, double out2, std::uint64_t* bits) {
  const auto cells = static_cast<std::int64_t>(axis.center.size());
  const double away2 = away * away;
  const auto distance2 = [&](std::int64_t k) {
    const double b = axis.center[static_cast<std::size_t>(k)] - center;
    return away2 + b * b;
  };
  const auto cell_of = [&](double at) {
    const double cell = std::floor((at - axis.lower) / axis.step);
    return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(cells - 1)));
  };
  std::int64_t nearest = cell_of(center);
  for (const std::int64_t k : {nearest - 1, nearest + 1})
    if (k >= 0 && k < cells && distance2(k) < distance2(nearest)) nearest = k;
  const auto neighbours = [&](double limit2, const auto& passes) {  // [first, end) around the nearest cell
    if (!passes(distance2(nearest))) return std::array<std::int64_t, 2>{0, 0};
    const double half = std::sqrt(std::fmax(0.0, limit2 - away2));
    std::int64_t first = std::min(cell_of(center - half), nearest), last = std::max(cell_of(center + half), nearest);
    while (!passes(distance2(first))) ++first;
    while (first > 0 && passes(distance2(first - 1))) --first;
    while (!passes(distance2(last))) --last;
    while (last < cells - 1 && passes(distance2(last + 1))) ++last;
    return std::array<std::int64_t, 2>{first, last + 1};
  };
  const auto within = neighbours(out2, [&](double distance) { return distance <= out2; });
  clear_bits(bits, 0, within[0]);
  clear_bits(bits, within[1], cells);
  const auto hole = neighbours(in2, [&](double distance) { return distance < in2; });
  clear_bits(bits, hole[0], hole[1]);
}

bool VoxelRows::fill_plane(const Design<double>& d, const Frame<double>& f, const Cuts& c, double at) {
  if (at < f.range[c.normal].lower || at > f.range[c.normal].upper) return false;
  const auto fill = [&](std::size_t coordinate, std::size_t other, const Axis& axis, Bits& bits) {
    set_bits(bits.data(), bits.size(), axis.center.size());
    const auto& range = f.range[coordinate];
    const auto begin = axis.center.begin(), end = axis.center.end();
    clear_bits(bits.data(), 0, std::lower_bound(begin, end, range.lower) - begin);
    clear_bits(bits.data(), std::upper_bound(begin, end, range.upper) - begin, end - begin);
    for (std::size_t i = 0; i < 4; ++i)
      if (kPlane[i][0] != other && kPlane[i][1] != other)
        cut_ring(axis, f.center[i][coordinate], at - f.center[i][c.normal], d.in2[i], d.out2[i], bits.data());
    return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
  };
  return fill(c.u, c.v, u_, plane_u_) && fill(c.v, c.u, v_, plane_v_);
}

void VoxelRows::fill_coupled(const Design<double>& d, const Frame<double>& f, const Cuts& c) {
  for (std::size_t j = 0; j < u_.center.size(); ++j) {
    std::uint64_t* const bits = coupled_.data() + j * words_;
    set_bits(bits, words_, v_.center.size());
    for (std::size_t i = 0; i < 4; ++i)
      if (kPlane[i][0] != c.normal && kPlane[i][1] != c.normal)
        cut_ring(v_, f.center[i][c.v], u_.center[j] - f.center[i][c.u], d.in2[i], d.out2[i], bits);
  }
}

}  // namespace pkm::crr_cru
