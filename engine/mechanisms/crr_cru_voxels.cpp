#include "engine/mechanisms/crr_cru_voxels.hpp"

#include <algorithm>

namespace pkm::crr_cru {
namespace {

/// Of the cells [first, end) those in word number w, as its bits.
std::uint64_t bits_of(std::int64_t first, std::int64_t end, std::size_t w) {
  const auto below = [w](std::int64_t cell) {
    const std::int64_t bit = cell - 64 * static_cast<std::int64_t>(w);
    const std::uint64_t some = (std::uint64_t{1} << (bit & 63)) - 1;
    return bit <= 0 ? 0 : bit >= 64 ? ~std::uint64_t{0} : some;
  };
  return below(end) & ~below(first);
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

void VoxelRows::prepare(const Design<double>& d, const Held& held, const VoxelGrid& grid, const GridAxes& axes) {
  const auto make = [](Axis& axis, std::size_t cells, double lower, double step) {
    axis.cells = cells;
    axis.lower = lower;
    axis.step = step;
    axis.center.resize((cells + kLanes - 1) / kLanes * kLanes);
  };
  const auto from_grid = [&](Axis& axis, std::size_t which) {
    make(axis, static_cast<std::size_t>(grid.cells[which]), grid.lower[which], grid.step[which]);
    for (std::size_t k = 0; k < axis.center.size(); ++k)
      axis.center[k] = grid.centre(which, static_cast<std::int64_t>(k));
  };
  from_grid(u_, axes.u);
  from_grid(v_, axes.v);
  if (held.coordinate == 3) {
    from_grid(n_, axes.outer);
  } else {
    make(n_, 1, 0, 0);
    std::ranges::fill(n_.center, held_value(d.g, held));
  }
  const auto lines = std::max(n_.center.size(), u_.center.size());
  for (auto* list : {&cells_.first, &cells_.end, &cells_.hole_first, &cells_.hole_end}) list->resize(lines);
  row_.resize((v_.cells + 63) / 64);
}

void VoxelRows::fill_tables(const Design<double>& d, const Frame<double>& f, const Cuts& c) {
  any_ = !f.singular && fill(d, f, c.normal, n_, c.u, u_, u_at_n_) && fill(d, f, c.normal, n_, c.v, v_, v_at_n_) &&
         fill(d, f, c.u, u_, c.v, v_, v_at_u_);
}

bool VoxelRows::fill(const Design<double>& d, const Frame<double>& f, std::size_t a, const Axis& across, std::size_t b,
                     const Axis& along, BitTable& table) {
  const std::size_t words = (along.cells + 63) / 64;
  const auto inside = [](const Axis& axis, const SlideRange<double>& range) {
    const auto begin = axis.center.begin(), end = begin + static_cast<std::ptrdiff_t>(axis.cells);
    return std::array{std::lower_bound(begin, end, range.lower) - begin,
                      std::upper_bound(begin, end, range.upper) - begin};
  };
  const auto [first, end] = inside(along, f.range[b]);
  range_.resize(words);
  for (std::size_t w = 0; w < words; ++w) range_[w] = bits_of(first, end, w);
  table.words = words;
  table.bits.assign(across.cells * words, 0);
  const auto [first_line, end_line] = inside(across, f.range[a]);
  const auto rows_begin = static_cast<std::size_t>(first_line), rows_end = static_cast<std::size_t>(end_line);
  for (std::size_t row = rows_begin; row < rows_end; ++row)
    for (std::size_t w = 0; w < words; ++w) table.bits[row * words + w] = range_[w];
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(kPlane[i][0] == a && kPlane[i][1] == b) && !(kPlane[i][0] == b && kPlane[i][1] == a)) continue;
    const RingLines lines{along.lower,
                          along.step,
                          static_cast<double>(along.cells),
                          across.center.data(),
                          across.center.size(),
                          f.center[i][b],
                          f.center[i][a],
                          d.in2[i],
                          d.out2[i]};
    with_instruction_set([&]<InstructionSet set>() { cells_in_ring<set>(lines, cells_); });
    const auto whole = [](double cell) { return static_cast<std::int64_t>(cell); };
    for (std::size_t row = rows_begin; row < rows_end; ++row)
      for (std::size_t w = 0; w < words; ++w)
        table.bits[row * words + w] &= bits_of(whole(cells_.first[row]), whole(cells_.end[row]), w) &
                                       ~bits_of(whole(cells_.hole_first[row]), whole(cells_.hole_end[row]), w);
  }
  return std::ranges::any_of(table.bits, [](std::uint64_t word) { return word != 0; });
}

}  // namespace pkm::crr_cru
