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
[[gnu::always_inline]] inline Ends<L> cells_that_pass(const RingLines& lines, const L& center, const L& away2,
                                                      const L& limit2, const Passes& passes) {
  const L half = root_or_zero(limit2 - away2), last_cell = lines.cells - 1;
  const auto distance2 = [&](const L& cell) {
    const L b = lines.lower + (cell + 0.5) * lines.step - center;
    return away2 + b * b;
  };
  const auto cell_at = [&](const L& place) { return (place - lines.lower) / lines.step - 0.5; };
  const L first = lesser(greater(ceil(cell_at(center - half)), L(0.0)), L(lines.cells));
  const L last = lesser(greater(floor(cell_at(center + half)), L(-1.0)), last_cell);
  const L before = first - 1.0, behind = last + 1.0;
  const L from =
      select((before >= 0.0) & passes(distance2(before)), before, select(passes(distance2(first)), first, first + 1.0));
  const L to = select((behind <= last_cell) & passes(distance2(behind)), behind,
                      select(passes(distance2(last)), last, last - 1.0));
  return {from, to + 1.0};
}

}  // namespace

template <InstructionSet set>
RingCells cells_in_rings(const RingLines& lines) {
  using L = LanesOf<set>;
  const L center = L::load(lines.center), away = L::load(lines.away), away2 = away * away;
  const L in2 = L::load(lines.in2), out2 = L::load(lines.out2);
  const auto within =
      cells_that_pass(lines, center, away2, out2, [&](const L& distance2) { return distance2 <= out2; });
  const auto hole = cells_that_pass(lines, center, away2, in2, [&](const L& distance2) { return distance2 < in2; });
  RingCells cells;
  within.first.store(cells.first);
  within.end.store(cells.end);
  hole.first.store(cells.hole_first);
  hole.end.store(cells.hole_end);
  return cells;
}

template RingCells cells_in_rings<PKM_INSTRUCTION_SET>(const RingLines&);

}  // namespace pkm::crr_cru
