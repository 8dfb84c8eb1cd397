#include "engine/accelerators/crr_cru/voxels.hpp"

#include <algorithm>
#include <utility>

namespace pkm::crr_cru {
namespace {

/// Word number w of a row of bits, of which only the bits [first, end) are set.
std::uint64_t bits_of(std::int64_t first, std::int64_t end, std::size_t w) {
  const auto below = [w](std::int64_t cell) {
    const std::int64_t bit = cell - 64 * static_cast<std::int64_t>(w);
    const std::uint64_t lowest = (std::uint64_t{1} << (bit & 63)) - 1;
    return bit <= 0 ? 0 : bit >= 64 ? ~std::uint64_t{0} : lowest;
  };
  return below(end) & ~below(first);
}

}  // namespace

Box default_box(const Design<double>& d, const FixedCoordinate& fixed) {
  const Geometry<double>& g = d.g;
  const auto [s, c] = sincos(fixed.coordinate == 3 ? fixed_value(g, fixed) : 0.0);
  const auto arm = arms(g, s, c);
  std::array<std::array<double, 2>, 4> range;
  for (std::size_t k = 0; k < 3; ++k) {
    // If phi is not fixed, rotation moves the platform joint along its rail by up to the radius r in both directions.
    const bool rotates = fixed.coordinate != 3 && arm[k].rotates && k < 2;
    const double shift = rotates ? 0 : arm[k].to_joint[k], reach = rotates ? g.r : 0;
    range[k] = {g.rho_min - shift - reach, g.rho_max - shift + reach};
  }
  const double delta = offset(d.yaw);
  range[3] = {-delta - kPi / 2, kPi / 2 - delta};
  Box box;
  for (std::size_t k = 0, axis = 0; k < 4; ++k)
    if (static_cast<int>(k) != fixed.coordinate) box[axis++] = range[k];
  return box;
}

void SliceCells::fill_axis(Axis& axis, const VoxelGrid& grid, std::size_t which) {
  const auto cells = static_cast<std::size_t>(grid.cells[which]);
  if (axis.cells == cells && axis.lower == grid.lower[which] && axis.step == grid.step[which])
    return;  // the table of this axis is independent of phi and was filled for an earlier phi
  axis.cells = cells;
  axis.lower = grid.lower[which];
  axis.step = grid.step[which];
  axis.center.resize((axis.cells + kLanes - 1) / kLanes * kLanes);
  for (std::size_t k = 0; k < axis.center.size(); ++k)
    axis.center[k] = grid.centre(which, static_cast<std::int64_t>(k));
}

bool SliceCells::fill(const Design<double>& d, const FixedCoordinate& fixed, const VoxelGrid& grid, double phi) {
  const PositionSet<double> set = position_set(d, phi);
  if (set.singular) return false;
  const GridAxes on_grid = grid_axes(fixed);
  const SliceAxes axes = slice_axes(fixed);
  fill_axis(u_, grid, on_grid.u);
  fill_axis(v_, grid, on_grid.v);
  if (axes.outer_is_phi) {
    n_ = {std::move(n_.center), 0, 0, 1};
    n_.center.assign(kLanes, fixed_value(d.g, fixed));
  } else {
    fill_axis(n_, grid, on_grid.outer);
  }
  return fill_table(d, set, axes.normal, n_, axes.u, u_, u_at_n_) &&
         fill_table(d, set, axes.normal, n_, axes.v, v_, v_at_n_) &&
         fill_table(d, set, axes.u, u_, axes.v, v_, v_at_u_);
}

PlaneTally SliceCells::count(std::size_t n) const {
  const PlaneRows rows{.u_row = u_at_n_.row(n).data(),
                       .v_row = v_at_n_.row(n).data(),
                       .v_at_u = v_at_u_.bits.data(),
                       .u_cells = u_.cells,
                       .v_cells = v_.cells,
                       .words = v_at_u_.words};
  return with_instruction_set([&]<InstructionSet set>() { return tally<set>(rows); });
}

bool SliceCells::fill_table(const Design<double>& d, const PositionSet<double>& set, std::size_t a, const Axis& across,
                            std::size_t b, const Axis& along, BitTable& table) {
  const std::size_t words = (along.cells + 63) / 64;
  const auto inside = [](const Axis& axis, const Interval<double>& range) {
    const auto begin = axis.center.begin(), end = begin + static_cast<std::ptrdiff_t>(axis.cells);
    return std::array{std::lower_bound(begin, end, range.lower) - begin,
                      std::upper_bound(begin, end, range.upper) - begin};
  };
  const auto [first, end] = inside(along, set.range[b]);
  table.words = words;
  table.bits.assign(across.center.size() * words, 0);
  const auto [first_line, end_line] = inside(across, set.range[a]);
  const auto rows_begin = static_cast<std::size_t>(first_line), rows_end = static_cast<std::size_t>(end_line);
  for (std::size_t w = 0; w < words; ++w) {
    const std::uint64_t word = bits_of(first, end, w);
    for (std::size_t row = rows_begin; row < rows_end; ++row) table.bits[row * words + w] = word;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (kLimbs[i].e == a || kLimbs[i].e == b) continue;  // the annulus of this limb lies in another plane
    const AnnulusLines lines{.lower = along.lower,
                             .step = along.step,
                             .cells = static_cast<double>(along.cells),
                             .across = across.center.data(),
                             .lines = across.center.size(),
                             .center_along = set.center[i][b],
                             .center_across = set.center[i][a],
                             .in2 = d.in2[i],
                             .out2 = d.out2[i]};
    with_instruction_set([&]<InstructionSet set>() { mask_annulus<set>(lines, words, table.bits.data()); });
  }
  return std::ranges::any_of(table.bits, [](std::uint64_t word) { return word != 0; });
}

}  // namespace pkm::crr_cru
