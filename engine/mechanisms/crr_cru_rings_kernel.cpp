#include "engine/mechanisms/crr_cru_rings.hpp"

namespace pkm::crr_cru {
namespace {

template <class L>
struct Ends {
  L first, end;
};

/// The cells around the ring's centre that pass. Rounding is monotonic, so they are neighbours; the ends of the chord
/// of radius sqrt(limit2) tell the first and the last of them but for rounding, and the plain test decides there.
template <class L, class Passes>
[[gnu::always_inline]] inline Ends<L> cells_that_pass(const RingLines& lines, const L& away2, double limit2,
                                                      const Passes& passes) {
  const double per_cell = 1 / lines.step, middle = (lines.center - lines.lower) * per_cell - 0.5;
  const L half = root_or_zero(limit2 - away2) * per_cell, last_cell = lines.cells - 1;
  const auto distance2 = [&](const L& cell) {
    const L b = lines.lower + (cell + 0.5) * lines.step - lines.center;
    return away2 + b * b;
  };
  const L first = lesser(greater(ceil(middle - half), L(0.0)), L(lines.cells));
  const L last = lesser(greater(floor(middle + half), L(-1.0)), last_cell);
  const L before = first - 1.0, behind = last + 1.0;
  const L from =
      select((before >= 0.0) & passes(distance2(before)), before, select(passes(distance2(first)), first, first + 1.0));
  const L to = select((behind <= last_cell) & passes(distance2(behind)), behind,
                      select(passes(distance2(last)), last, last - 1.0));
  return {from, to + 1.0};
}

/// @param words  of a row; where it is a constant, loops over words vanish
[[gnu::always_inline]] inline PlaneTally tally_of(const PlaneRows& rows, std::size_t words) {
  std::int64_t cells = 0;
  std::uint64_t at_ends_of_u = 0, in_first = 0, in_last = 0;  // words of v
  for (std::size_t u = 0; u < rows.u_cells; ++u) {
    const std::uint64_t all_or_none = -(rows.of_u[u / 64] >> (u % 64) & 1);
    const std::uint64_t at_end = u == 0 || u == rows.u_cells - 1 ? ~std::uint64_t{0} : 0;
    for (std::size_t w = 0; w < words; ++w) {
      const std::uint64_t word = all_or_none & rows.of_v[w] & rows.at_u[u * words + w];
      cells += __builtin_popcountll(word);
      at_ends_of_u |= word & at_end;
      if (w == 0) in_first |= word;
      if (w == words - 1) in_last |= word;
    }
  }
  return {cells, at_ends_of_u != 0 || (in_first & 1) != 0 || (in_last >> ((rows.v_cells - 1) % 64) & 1) != 0};
}

}  // namespace

template <InstructionSet set>
void cells_in_ring(const RingLines& lines, RingCells& cells) {
  using L = LanesOf<set>;
  for (std::size_t line = 0; line < lines.lines; line += kLanes) {
    const L away = L::load(lines.place + line) - lines.across, away2 = away * away;
    const auto within =
        cells_that_pass(lines, away2, lines.out2, [&](const L& distance2) { return distance2 <= lines.out2; });
    const auto hole =
        cells_that_pass(lines, away2, lines.in2, [&](const L& distance2) { return distance2 < lines.in2; });
    within.first.store(&cells.first[line]);
    within.end.store(&cells.end[line]);
    hole.first.store(&cells.hole_first[line]);
    hole.end.store(&cells.hole_end[line]);
  }
}

template <InstructionSet set>
PlaneTally tally(const PlaneRows& rows) {
  return rows.words == 1 ? tally_of(rows, 1) : tally_of(rows, rows.words);
}

template PlaneTally tally<PKM_INSTRUCTION_SET>(const PlaneRows&);
template void cells_in_ring<PKM_INSTRUCTION_SET>(const RingLines&, RingCells&);

}  // namespace pkm::crr_cru
