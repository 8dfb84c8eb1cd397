#include "engine/generic/cells.hpp"

#include <algorithm>
#include <bit>

#include "engine/core/stop.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

using expression::kRow;

/// Writes the centres of cells [first, first + count) along an axis, padded to a multiple of kLanes.
/// @return the padded number of values
std::size_t fill_centres(const VoxelGrid& grid, std::size_t axis, std::size_t first, std::size_t count, double* to) {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; ++k) to[k] = grid.centre(axis, static_cast<std::int64_t>(first + k));
  return whole;
}

/// One word of a bit set in which the bits from `from` up to, but excluding, `to` are set.
/// @param word  index of the word
std::uint64_t range_of_bits(double from, double to, std::size_t word) {
  const double first = static_cast<double>(word * 64);
  const auto below = [&](double end) {  // word with the bits before `end` set
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

void CellTest::start(const std::vector<double>& inputs, CellScratch& scratch) const {
  scratch.registers.resize(plan_.program.registers());
  scratch.middle_rows.resize(plan_.middle->slots() * kRow);
  scratch.rows.resize(plan_.inner->slots() * kRow);
  plan_.program.start<double>(scratch.registers);
  plan_.program.run<double>(0, inputs, scratch.registers);
}

CellTally CellTest::test(const VoxelGrid& grid, std::size_t outer, bool want_bits, CellScratch& scratch) const {
  const auto [slices, columns, cells] = shape(grid);
  if (want_bits) scratch.bits.assign(columns * words(cells), 0);
  for (const auto& input : plan_.program.stages()[kOuter].inputs)
    scratch.registers[input.to] = grid.centre(plan_.order[0], static_cast<std::int64_t>(outer));
  plan_.program.run<double>(kOuter, scratch.registers);
  CellTally tally;
  if (!std::ranges::all_of(plan_.outer_constraints,
                           [&](std::uint32_t at) { return is_satisfied(scratch.registers[at]); }))
    return tally;
  for (std::size_t first = 0; first < columns; first += kRow) {
    check_stop();
    const CellTally part = test_columns(grid, outer, first, std::min(kRow, columns - first), want_bits, scratch);
    tally.cells += part.cells;
    tally.touches_box = tally.touches_box || part.touches_box;
  }
  return tally;
}

CellTally CellTest::test_columns(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                 bool want_bits, CellScratch& scratch) const {
  const std::size_t cells = shape(grid)[2], length = words(cells), inner = plan_.order.back();
  const ColumnGrid column_grid = {grid.centre(inner, 0), grid.step[inner], static_cast<double>(cells)};
  const bool has_holes = find_ranges(grid, first, count, column_grid, scratch);
  if (!want_bits && !has_holes && plan_.disjunctions.empty() && plan_.cranks.empty() && plan_.inner_constraints.empty())
    return tally_of_ranges(grid, outer, first, count, scratch.ranges);
  if (!want_bits) scratch.bits.resize((first + count) * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      scratch.bits[(first + j) * length + word] = range_of_bits(scratch.ranges.from[j], scratch.ranges.to[j], word) &
                                                  ~(has_holes ? scratch.hole[j * length + word] : 0);
  clear_bits(grid, first, count, column_grid, scratch);
  return tally_of_bits(grid, outer, first, count, scratch.bits);
}

bool CellTest::find_ranges(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                           CellScratch& scratch) const {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes, length = words(shape(grid)[2]);
  for (const std::uint32_t slot : plan_.middle->inputs())
    fill_centres(grid, plan_.order[plan_.order.size() - 2], first, count, &scratch.middle_rows[slot * kRow]);
  const double* const registers = scratch.registers.data();
  double* const rows = scratch.middle_rows.data();
  plan_.middle->run(registers, rows, whole);

  CellRanges& ranges = scratch.ranges;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), count, column_grid.cells);
  std::fill(ranges.to.begin() + static_cast<std::ptrdiff_t>(count),
            ranges.to.begin() + static_cast<std::ptrdiff_t>(whole), 0.0);
  for (const std::uint32_t at : plan_.middle_constraints) {
    const double* const row = rows + plan_.middle->operand(at).index * kRow;
    for (std::size_t j = 0; j < count; ++j) ranges.to[j] = is_satisfied(row[j]) ? ranges.to[j] : 0;
  }
  bool has_holes = false;
  for (const ColumnConstraint& constraint : plan_.columns) {
    const bool holes = with_instruction_set(
        [&]<InstructionSet set> { return contract<set>(constraint, registers, rows, column_grid, whole, ranges); });
    if (!holes) continue;
    if (!has_holes) scratch.hole.assign(count * length, 0);
    has_holes = true;
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t word = 0; word < length; ++word)
        scratch.hole[j * length + word] |= range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
  }
  return has_holes;
}

CellTally CellTest::tally_of_ranges(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                    const CellRanges& ranges) const {
  const auto cells = static_cast<double>(shape(grid)[2]);
  double sum = 0, at_ends = 0;  // computed without branches, so that the loop over the columns is vectorised
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

void CellTest::bits_of(const ColumnConstraint& constraint, const ColumnGrid& column_grid, std::size_t count,
                       CellScratch& scratch, std::vector<std::uint64_t>& bits) const {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes,
                    length = words(static_cast<std::size_t>(column_grid.cells));
  CellRanges& ranges = scratch.other;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), whole, column_grid.cells);
  for (auto* const hole : {&ranges.hole_from, &ranges.hole_to}) std::fill_n(hole->begin(), whole, 0.0);
  with_instruction_set([&]<InstructionSet set> {
    contract<set>(constraint, scratch.registers.data(), scratch.middle_rows.data(), column_grid, whole, ranges);
  });
  bits.resize(count * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      bits[j * length + word] = range_of_bits(ranges.from[j], ranges.to[j], word) &
                                ~range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
}

void CellTest::find_crank_bits(std::size_t i, const ColumnGrid& column_grid, std::size_t count,
                               CellScratch& scratch) const {
  const CellPlan::Crank& crank = plan_.cranks[i];
  bits_of(crank.at_min, column_grid, count, scratch, scratch.at_min);
  bits_of(crank.at_max, column_grid, count, scratch, scratch.at_max);
  bits_of(crank.after_min, column_grid, count, scratch, scratch.after_min);
  bits_of(crank.before_max, column_grid, count, scratch, scratch.before_max);
  const bool is_half = scratch.registers[crank.half_turn] >= 0;
  std::vector<std::uint64_t>&in = scratch.in_range[i], &if_reached = scratch.if_reached[i];
  in.resize(scratch.at_min.size());
  if_reached.resize(scratch.at_min.size());
  for (std::size_t k = 0; k < in.size(); ++k) {
    const std::uint64_t f1 = scratch.at_min[k], f2 = scratch.at_max[k];
    const std::uint64_t p1 = scratch.after_min[k], p2 = scratch.before_max[k];
    // Bit sets of the cells in which phi, the mean of the two crank angles at which the limb assembles, or phi + pi is
    // in the range of the crank (limbs::CrankRange).
    const std::uint64_t phi = is_half ? p1 & p2 : p1 | p2, opposite = is_half ? ~p1 & ~p2 : ~p1 | ~p2;
    in[k] = crank.is_first ? f1 & ~f2 : ~f1 & f2;
    if_reached[k] = (f1 & f2 & phi) | (~f1 & ~f2 & opposite);
  }
}

void CellTest::clear_bits(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                          CellScratch& scratch) const {
  const std::size_t length = words(shape(grid)[2]);
  std::uint64_t* const bits = &scratch.bits[first * length];
  for (const CellPlan::Disjunction& disjunction : plan_.disjunctions) {
    scratch.any.assign(count * length, 0);
    for (const ColumnConstraint& alternative : disjunction) {
      bits_of(alternative, column_grid, count, scratch, scratch.hole);
      for (std::size_t k = 0; k < count * length; ++k) scratch.any[k] |= scratch.hole[k];
    }
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= scratch.any[k];
  }
  scratch.in_range.resize(plan_.cranks.size());
  scratch.if_reached.resize(plan_.cranks.size());
  for (std::size_t i = 0; i < plan_.cranks.size(); ++i) {
    find_crank_bits(i, column_grid, count, scratch);
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= scratch.in_range[i][k] | scratch.if_reached[i][k];
  }
  for (std::size_t j = 0; j < count; ++j) {
    bool has_open_cells = false;  // true: in at least one cell, constraints of the inner loop have to be tested
    for (std::size_t k = j * length; k < (j + 1) * length; ++k) {
      has_open_cells = has_open_cells || (!plan_.inner_constraints.empty() && bits[k] != 0);
      for (const auto& if_reached : scratch.if_reached)
        has_open_cells = has_open_cells || (bits[k] & if_reached[k]) != 0;
    }
    if (!has_open_cells) continue;
    for (const std::uint32_t at : plan_.passed_to_inner)
      scratch.registers[at] = scratch.middle_rows[plan_.middle->operand(at).index * kRow + j];
    test_cells(grid, first, j, scratch);
  }
}

void CellTest::test_cells(const VoxelGrid& grid, std::size_t first_column, std::size_t j, CellScratch& scratch) const {
  static_assert(kRow == 64);  // one batch of cells corresponds to one word of the bit set
  const std::size_t cells = shape(grid)[2], length = words(cells);
  for (std::size_t word = 0; word < length; ++word) {
    std::uint64_t& bits = scratch.bits[(first_column + j) * length + word];
    if (bits == 0) continue;
    const std::size_t first = word * kRow, count = std::min(kRow, cells - first);
    std::size_t whole = kLanes;
    for (const std::uint32_t slot : plan_.inner->inputs())
      whole = fill_centres(grid, plan_.order.back(), first, count, &scratch.rows[slot * kRow]);
    plan_.inner->run(scratch.registers.data(), scratch.rows.data(), whole);
    const auto satisfied = [&](std::uint32_t constraint) {
      const double* const row = &scratch.rows[plan_.inner->operand(constraint).index * kRow];
      std::uint64_t found = 0;
      for (std::size_t k = 0; k < count; ++k) found |= static_cast<std::uint64_t>(is_satisfied(row[k])) << k;
      return found;
    };
    for (const std::uint32_t constraint : plan_.inner_constraints) bits &= satisfied(constraint);
    for (std::size_t i = 0; i < plan_.cranks.size(); ++i)
      bits &= scratch.in_range[i][j * length + word] |
              (scratch.if_reached[i][j * length + word] & satisfied(plan_.cranks[i].reach));
  }
}

}  // namespace pkm::generic
