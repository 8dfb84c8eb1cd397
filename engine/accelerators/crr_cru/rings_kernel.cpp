#include "engine/accelerators/crr_cru/rings.hpp"

#include <cstring>

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
  const L half = sqrt_or_zero(limit2 - away2) * per_cell, last_cell = lines.cells - 1;
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

template <int W>
struct Words {
  typedef unsigned long long Part __attribute__((vector_size(8 * W)));
  Part part[kLanes / W];
};

/// Of the 64 cells from `start` on, those from `cell` on, as bits.
template <int W>
[[gnu::always_inline]] inline Words<W> from_on(const Lanes<W>& cell, double start) {
  constexpr double kWhole = 0x1p52;  // the bits of a number of this size end in the whole number that was added
  const Lanes<W> skipped = lesser(greater(cell - start, Lanes<W>(0.0)), Lanes<W>(64.0)) + kWhole;
  Words<W> bits;
  for (int i = 0; i < kLanes / W; ++i) {
    typedef typename Words<W>::Part Part;
    const Part n = (Part)skipped.part[i] & 127, half = n >> 1;
    bits.part[i] = (Part{} + ~0ULL) << half << (n - half);  // in two steps, because 64 in one is not defined
  }
  return bits;
}

/// @param words  of a row; where it is a constant, loops over words vanish
template <class L>
[[gnu::always_inline]] inline void keep_ring_of(const RingLines& lines, std::size_t words, std::uint64_t* rows) {
  for (std::size_t line = 0; line < lines.lines; line += kLanes) {
    const L away = L::load(lines.place + line) - lines.across, away2 = away * away;
    const Ends<L> within =
        cells_that_pass(lines, away2, lines.out2, [&](const L& distance2) { return distance2 <= lines.out2; });
    const Ends<L> hole =
        cells_that_pass(lines, away2, lines.in2, [&](const L& distance2) { return distance2 < lines.in2; });
    for (std::size_t w = 0; w < words; ++w) {
      const double start = 64.0 * static_cast<double>(w);
      auto ring = from_on(within.first, start);
      const auto behind = from_on(within.end, start);
      const auto in = from_on(hole.first, start), out = from_on(hole.end, start);
      for (std::size_t i = 0; i < sizeof ring.part / sizeof ring.part[0]; ++i)
        ring.part[i] &= ~behind.part[i] & ~(in.part[i] & ~out.part[i]);
      std::uint64_t row[kLanes];
      std::memcpy(row, ring.part, sizeof row);
      for (std::size_t k = 0; k < kLanes; ++k) rows[(line + k) * words + w] &= row[k];
    }
  }
}

[[gnu::always_inline]] inline PlaneTally tally_of(const PlaneRows& rows, std::size_t words) {
  std::int64_t cells = 0;
  std::uint64_t in_first = 0, in_last = 0;  // words of v
  for (std::size_t of_u = 0; 64 * of_u < rows.u_cells; ++of_u)
    for (std::uint64_t bits = rows.of_u[of_u]; bits != 0; bits &= bits - 1) {
      const std::uint64_t* at_u = rows.at_u + (64 * of_u + static_cast<std::size_t>(__builtin_ctzll(bits))) * words;
      for (std::size_t w = 0; w < words; ++w) cells += __builtin_popcountll(rows.of_v[w] & at_u[w]);
      in_first |= at_u[0];
      in_last |= at_u[words - 1];
    }
  const std::size_t last_u = rows.u_cells - 1, last_v = rows.v_cells - 1;
  std::uint64_t at_ends = (rows.of_v[0] & in_first & 1) | ((rows.of_v[words - 1] & in_last) >> (last_v % 64) & 1);
  for (const std::size_t u : {std::size_t{0}, last_u})
    for (std::size_t w = 0; w < words && (rows.of_u[u / 64] >> (u % 64) & 1); ++w)
      at_ends |= rows.of_v[w] & rows.at_u[u * words + w];
  return {cells, at_ends != 0};
}

}  // namespace

template <InstructionSet set>
void keep_ring(const RingLines& lines, std::size_t words, std::uint64_t* rows) {
  using L = LanesOf<set>;
  words == 1 ? keep_ring_of<L>(lines, 1, rows) : keep_ring_of<L>(lines, words, rows);
}

template <InstructionSet set>
PlaneTally tally(const PlaneRows& rows) {
  return rows.words == 1 ? tally_of(rows, 1) : tally_of(rows, rows.words);
}

template PlaneTally tally<PKM_INSTRUCTION_SET>(const PlaneRows&);
template void keep_ring<PKM_INSTRUCTION_SET>(const RingLines&, std::size_t, std::uint64_t*);

}  // namespace pkm::crr_cru
