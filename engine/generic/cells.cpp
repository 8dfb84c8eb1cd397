#include "engine/generic/cells.hpp"

#include <algorithm>
#include <bit>

#include "engine/core/stop.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

using expression::kRow;

/// Centres of cells [first, first + count), and of some beyond, up to whole lanes.
std::size_t fill_centres(const VoxelGrid& grid, std::size_t axis, std::size_t first, std::size_t count, double* to) {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; ++k) to[k] = grid.centre(axis, static_cast<std::int64_t>(first + k));
  return whole;
}

/// Bits [from, to) of a word.
std::uint64_t range_of_bits(double from, double to, std::size_t word) {
  const double first = static_cast<double>(word * 64);
  const auto below = [&](double end) {  // bits before it
    const double bits = std::clamp(end - first, 0.0, 64.0);
    return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
  };
  return below(to) & ~below(from);
}

}  // namespace

std::array<std::size_t, 3> CellTest::shape(const VoxelGrid& grid) const {
  std::array<std::size_t, 3> cells = {1, 1, 1};
  for (std::size_t i = 0; i < plan_.order.size(); ++i)
    cells[3 - plan_.order.size() + i] = static_cast<std::size_t>(grid.cells[plan_.order[i]]);
  return cells;
}

std::array<std::int64_t, 3> CellTest::cell(std::size_t outer, std::size_t middle, std::size_t inner) const {
  const std::size_t loops[3] = {outer, middle, inner};
  std::array<std::int64_t, 3> cell{};
  for (std::size_t i = 0; i < plan_.order.size(); ++i)
    cell[plan_.order[i]] = static_cast<std::int64_t>(loops[3 - plan_.order.size() + i]);
  return cell;
}

bool CellTest::is_outermost(const VoxelGrid& grid, std::size_t outer) const {
  return plan_.order.size() == 3 && (outer == 0 || outer + 1 == shape(grid)[0]);
}

bool CellTest::at_side(const VoxelGrid& grid, std::size_t outer, std::size_t middle) const {
  return is_outermost(grid, outer) || (plan_.order.size() >= 2 && (middle == 0 || middle + 1 == shape(grid)[1]));
}

void CellTest::start(const std::vector<double>& inputs, CellRoom& room) const {
  room.registers.resize(plan_.program.registers());
  room.middle_rows.resize(plan_.middle->slots() * kRow);
  room.rows.resize(plan_.inner->slots() * kRow);
  plan_.program.start<double>(room.registers);
  plan_.program.run<double>(0, inputs, room.registers);
}

CellTally CellTest::test(const VoxelGrid& grid, std::size_t outer, bool want_bits, CellRoom& room) const {
  const auto [slices, columns, cells] = shape(grid);
  if (want_bits) room.bits.assign(columns * words(cells), 0);
  for (const auto& input : plan_.program.stages()[kOuter].inputs)
    room.registers[input.to] = grid.centre(plan_.order[0], static_cast<std::int64_t>(outer));
  plan_.program.run<double>(kOuter, room.registers);
  CellTally tally;
  if (!std::ranges::all_of(plan_.early, [&](std::uint32_t at) { return is_satisfied(room.registers[at]); }))
    return tally;
  for (std::size_t first = 0; first < columns; first += kRow) {
    check_stop();
    const CellTally part = test_columns(grid, outer, first, std::min(kRow, columns - first), want_bits, room);
    tally.cells += part.cells;
    tally.touches_box = tally.touches_box || part.touches_box;
  }
  return tally;
}

CellTally CellTest::test_columns(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                 bool want_bits, CellRoom& room) const {
  const std::size_t cells = shape(grid)[2], length = words(cells), inner = plan_.order.back();
  const ColumnGrid column_grid = {grid.centre(inner, 0), grid.step[inner], static_cast<double>(cells)};
  const bool has_holes = narrow_ranges(grid, first, count, column_grid, room);
  if (!want_bits && !has_holes && plan_.alternatives.empty() && plan_.cranks.empty() && plan_.of_inner.empty())
    return tally_of_ranges(grid, outer, first, count, room.ranges);
  if (!want_bits) room.bits.resize((first + count) * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      room.bits[(first + j) * length + word] =
          range_of_bits(room.ranges.from[j], room.ranges.to[j], word) & ~(has_holes ? room.hole[j * length + word] : 0);
  find_bits(grid, first, count, column_grid, room);
  return tally_of_bits(grid, outer, first, count, room.bits);
}

bool CellTest::narrow_ranges(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                             CellRoom& room) const {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes, length = words(shape(grid)[2]);
  for (const std::uint32_t slot : plan_.middle->inputs())
    fill_centres(grid, plan_.order[plan_.order.size() - 2], first, count, &room.middle_rows[slot * kRow]);
  const double* const registers = room.registers.data();
  double* const rows = room.middle_rows.data();
  plan_.middle->run(registers, rows, whole);

  CellRanges& ranges = room.ranges;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), count, column_grid.cells);
  std::fill(ranges.to.begin() + static_cast<std::ptrdiff_t>(count),
            ranges.to.begin() + static_cast<std::ptrdiff_t>(whole), 0.0);
  for (const std::uint32_t at : plan_.of_middle) {
    const double* const row = rows + plan_.middle->operand(at).index * kRow;
    for (std::size_t j = 0; j < count; ++j) ranges.to[j] = is_satisfied(row[j]) ? ranges.to[j] : 0;
  }
  bool has_holes = false;
  for (const ColumnCondition& condition : plan_.columns) {
    const bool holes = with_instruction_set(
        [&]<InstructionSet set> { return narrow<set>(condition, registers, rows, column_grid, whole, ranges); });
    if (!holes) continue;
    if (!has_holes) room.hole.assign(count * length, 0);
    has_holes = true;
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t word = 0; word < length; ++word)
        room.hole[j * length + word] |= range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
  }
  return has_holes;
}

CellTally CellTest::tally_of_ranges(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                    const CellRanges& ranges) const {
  const auto cells = static_cast<double>(shape(grid)[2]);
  double sum = 0, at_ends = 0;  // both without a branch
  const auto number = [&](std::size_t j) { return std::max(ranges.to[j] - ranges.from[j], 0.0); };
  for (std::size_t j = 0; j < count; ++j) {
    sum += number(j);
    at_ends += ranges.from[j] == 0 || ranges.to[j] == cells ? number(j) : 0;
  }
  const auto is_side = [&](std::size_t j) { return number(j) > 0 && at_side(grid, outer, first + j); };
  return {.cells = static_cast<std::int64_t>(sum),
          .touches_box = at_ends > 0 || is_side(0) || is_side(count - 1) || (sum > 0 && is_outermost(grid, outer))};
}

CellTally CellTest::tally_of_bits(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                  const std::vector<std::uint64_t>& all) const {
  const std::size_t cells = shape(grid)[2], length = words(cells);
  CellTally tally;
  for (std::size_t j = 0; j < count; ++j) {
    const std::uint64_t* const bits = &all[(first + j) * length];
    std::int64_t number = 0;
    for (std::size_t word = 0; word < length; ++word) number += std::popcount(bits[word]);
    tally.cells += number;
    if (number == 0 || tally.touches_box) continue;
    const bool last = (bits[(cells - 1) / 64] >> ((cells - 1) % 64) & 1) != 0;
    tally.touches_box = (bits[0] & 1) != 0 || last || at_side(grid, outer, first + j);
  }
  return tally;
}

void CellTest::bits_of(const ColumnCondition& condition, const ColumnGrid& column_grid, std::size_t count,
                       CellRoom& room, std::vector<std::uint64_t>& bits) const {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes,
                    length = words(static_cast<std::size_t>(column_grid.cells));
  CellRanges& ranges = room.other;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), whole, column_grid.cells);
  for (auto* const hole : {&ranges.hole_from, &ranges.hole_to}) std::fill_n(hole->begin(), whole, 0.0);
  with_instruction_set([&]<InstructionSet set> {
    narrow<set>(condition, room.registers.data(), room.middle_rows.data(), column_grid, whole, ranges);
  });
  bits.resize(count * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      bits[j * length + word] = range_of_bits(ranges.from[j], ranges.to[j], word) &
                                ~range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
}

/// What limbs::CrankRange says of the cells of some columns.
void CellTest::find_crank_bits(std::size_t i, const ColumnGrid& column_grid, std::size_t count, CellRoom& room) const {
  const CellPlan::Crank& crank = plan_.cranks[i];
  bits_of(crank.at_min, column_grid, count, room, room.at_min);
  bits_of(crank.at_max, column_grid, count, room, room.at_max);
  bits_of(crank.after_min, column_grid, count, room, room.after_min);
  bits_of(crank.before_max, column_grid, count, room, room.before_max);
  const bool is_half = room.registers[crank.half_turn] >= 0;
  std::vector<std::uint64_t>&in = room.in_range[i], &maybe = room.if_reached[i];
  in.resize(room.at_min.size());
  maybe.resize(room.at_min.size());
  for (std::size_t k = 0; k < in.size(); ++k) {
    const std::uint64_t f1 = room.at_min[k], f2 = room.at_max[k], p1 = room.after_min[k], p2 = room.before_max[k];
    const std::uint64_t middle = is_half ? p1 & p2 : p1 | p2, opposite = is_half ? ~p1 & ~p2 : ~p1 | ~p2;
    in[k] = crank.is_first ? f1 & ~f2 : ~f1 & f2;
    maybe[k] = (f1 & f2 & middle) | (~f1 & ~f2 & opposite);
  }
}

/// What is left of room.bits by conditions with alternatives, by cranks, and by what is tested cell by cell.
void CellTest::find_bits(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                         CellRoom& room) const {
  const std::size_t length = words(shape(grid)[2]);
  std::uint64_t* const bits = &room.bits[first * length];
  for (const CellPlan::Alternatives& alternatives : plan_.alternatives) {
    room.some.assign(count * length, 0);
    for (const ColumnCondition& alternative : alternatives) {
      bits_of(alternative, column_grid, count, room, room.hole);
      for (std::size_t k = 0; k < count * length; ++k) room.some[k] |= room.hole[k];
    }
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= room.some[k];
  }
  room.in_range.resize(plan_.cranks.size());
  room.if_reached.resize(plan_.cranks.size());
  for (std::size_t i = 0; i < plan_.cranks.size(); ++i) {
    find_crank_bits(i, column_grid, count, room);
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= room.in_range[i][k] | room.if_reached[i][k];
  }
  for (std::size_t j = 0; j < count; ++j) {
    bool is_open = false;
    for (std::size_t k = j * length; k < (j + 1) * length; ++k) {
      is_open = is_open || (!plan_.of_inner.empty() && bits[k] != 0);
      for (const auto& maybe : room.if_reached) is_open = is_open || (bits[k] & maybe[k]) != 0;
    }
    if (!is_open) continue;
    for (const std::uint32_t at : plan_.handed_down)
      room.registers[at] = room.middle_rows[plan_.middle->operand(at).index * kRow + j];
    test_cells(grid, first, j, room);
  }
}

/// Column first + j; j counts in what find_bits() found of cranks.
void CellTest::test_cells(const VoxelGrid& grid, std::size_t column_0, std::size_t j, CellRoom& room) const {
  static_assert(kRow == 64);  // a row is a word
  const std::size_t cells = shape(grid)[2], length = words(cells);
  for (std::size_t word = 0; word < length; ++word) {
    std::uint64_t& bits = room.bits[(column_0 + j) * length + word];
    if (bits == 0) continue;
    const std::size_t first = word * kRow, count = std::min(kRow, cells - first);
    std::size_t whole = kLanes;
    for (const std::uint32_t slot : plan_.inner->inputs())
      whole = fill_centres(grid, plan_.order.back(), first, count, &room.rows[slot * kRow]);
    plan_.inner->run(room.registers.data(), room.rows.data(), whole);
    const auto holds = [&](std::uint32_t condition) {
      const double* const row = &room.rows[plan_.inner->operand(condition).index * kRow];
      std::uint64_t found = 0;
      for (std::size_t k = 0; k < count; ++k) found |= static_cast<std::uint64_t>(is_satisfied(row[k])) << k;
      return found;
    };
    for (const std::uint32_t condition : plan_.of_inner) bits &= holds(condition);
    for (std::size_t i = 0; i < plan_.cranks.size(); ++i)
      bits &=
          room.in_range[i][j * length + word] | (room.if_reached[i][j * length + word] & holds(plan_.cranks[i].reach));
  }
}

}  // namespace pkm::generic
