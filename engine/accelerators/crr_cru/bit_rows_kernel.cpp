#include "engine/accelerators/crr_cru/bit_rows.hpp"

#include <cstring>

namespace pkm::crr_cru {
namespace {

/// For each line, the cells [first, end) that satisfy one of the two inequalities of the annulus.
template <class L>
struct CellRange {
  L first, end;
};

/// The cells of each line whose squared distance from the centre of the annulus passes a comparison with `limit2`, the
/// squared radius of a circle. Rounding is monotonic, so these cells are contiguous. The endpoints of the chord give
/// the first and the last cell up to rounding errors; the cells next to the endpoints are decided by the comparison
/// itself.
template <class L, class Passes>
[[gnu::always_inline]] inline CellRange<L> cells_that_pass(const AnnulusLines& lines, const L& away2, double limit2,
                                                           const Passes& passes) {
  const double per_cell = 1 / lines.step, middle = (lines.center_along - lines.lower) * per_cell - 0.5;
  const L half = sqrt_or_zero(limit2 - away2) * per_cell, last_cell = lines.cells - 1;
  const auto distance2 = [&](const L& cell) {
    const L b = lines.lower + (cell + 0.5) * lines.step - lines.center_along;
    return away2 + b * b;
  };
  const L first = lesser(greater(ceil(middle - half), L(0.0)), L(lines.cells));
  const L last = lesser(greater(floor(middle + half), L(-1.0)), last_cell);
  const L before = first - 1.0, after = last + 1.0;
  const L from =
      select((before >= 0.0) & passes(distance2(before)), before, select(passes(distance2(first)), first, first + 1.0));
  const L to =
      select((after <= last_cell) & passes(distance2(after)), after, select(passes(distance2(last)), last, last - 1.0));
  return {from, to + 1.0};
}

template <int W>
struct Words {
  typedef unsigned long long Part __attribute__((vector_size(8 * W)));
  Part part[kLanes / W];
};

/// One 64-bit word per line for the cells [start, start + 64): bits of cells with an index >= `cell` are set.
template <int W>
[[gnu::always_inline]] inline Words<W> bits_from(const Lanes<W>& cell, double start) {
  constexpr double kShift = 0x1p52;  // adding it to an integer below 2^52 places the integer in the lowest bits
  const Lanes<W> skipped = lesser(greater(cell - start, Lanes<W>(0.0)), Lanes<W>(64.0)) + kShift;
  Words<W> bits;
  for (int i = 0; i < kLanes / W; ++i) {
    typedef typename Words<W>::Part Part;
    const Part n = (Part)skipped.part[i] & 127, half = n >> 1;
    // The mask is shifted in two steps, because a shift by 64 is undefined in C++.
    bits.part[i] = (Part{} + ~0ULL) << half << (n - half);
  }
  return bits;
}

/// Clears the bits of all cells outside the annulus, for kLanes lines at a time.
/// @param words  number of words per row; if it is the compile-time constant 1, the compiler removes the loop over
///               words
template <class L>
[[gnu::always_inline]] inline void mask_annulus_of(const AnnulusLines& lines, std::size_t words, std::uint64_t* rows) {
  for (std::size_t line = 0; line < lines.lines; line += kLanes) {
    const L away = L::load(lines.across + line) - lines.center_across, away2 = away * away;
    const CellRange<L> disk =
        cells_that_pass(lines, away2, lines.out2, [&](const L& distance2) { return distance2 <= lines.out2; });
    const CellRange<L> hole =
        cells_that_pass(lines, away2, lines.in2, [&](const L& distance2) { return distance2 < lines.in2; });
    for (std::size_t w = 0; w < words; ++w) {
      const double start = 64.0 * static_cast<double>(w);
      auto annulus = bits_from(disk.first, start);
      const auto after = bits_from(disk.end, start);
      const auto in = bits_from(hole.first, start), out = bits_from(hole.end, start);
      for (std::size_t i = 0; i < sizeof annulus.part / sizeof annulus.part[0]; ++i)
        annulus.part[i] &= ~after.part[i] & ~(in.part[i] & ~out.part[i]);
      std::uint64_t row[kLanes];
      std::memcpy(row, annulus.part, sizeof row);
      for (std::size_t k = 0; k < kLanes; ++k) rows[(line + k) * words + w] &= row[k];
    }
  }
}

[[gnu::always_inline]] inline PlaneTally tally_of(const PlaneRows& rows, std::size_t words) {
  std::int64_t cells = 0;
  std::uint64_t any_first = 0, any_last = 0;  // bitwise OR, over all u, of the first and of the last words along v
  for (std::size_t u_word = 0; 64 * u_word < rows.u_cells; ++u_word)
    for (std::uint64_t bits = rows.u_row[u_word]; bits != 0; bits &= bits - 1) {
      const std::size_t u = 64 * u_word + static_cast<std::size_t>(__builtin_ctzll(bits));
      const std::uint64_t* v_at_u = rows.v_at_u + u * words;
      for (std::size_t w = 0; w < words; ++w) cells += __builtin_popcountll(rows.v_row[w] & v_at_u[w]);
      any_first |= v_at_u[0];
      any_last |= v_at_u[words - 1];
    }
  const std::size_t last_u = rows.u_cells - 1, last_v = rows.v_cells - 1;
  std::uint64_t touching = (rows.v_row[0] & any_first & 1) | ((rows.v_row[words - 1] & any_last) >> (last_v % 64) & 1);
  for (const std::size_t u : {std::size_t{0}, last_u})
    for (std::size_t w = 0; w < words && (rows.u_row[u / 64] >> (u % 64) & 1); ++w)
      touching |= rows.v_row[w] & rows.v_at_u[u * words + w];
  return {cells, touching != 0};
}

}  // namespace

template <InstructionSet set>
void mask_annulus(const AnnulusLines& lines, std::size_t words, std::uint64_t* rows) {
  using L = LanesOf<set>;
  words == 1 ? mask_annulus_of<L>(lines, 1, rows) : mask_annulus_of<L>(lines, words, rows);
}

template <InstructionSet set>
PlaneTally tally(const PlaneRows& rows) {
  return rows.words == 1 ? tally_of(rows, 1) : tally_of(rows, rows.words);
}

template PlaneTally tally<PKM_INSTRUCTION_SET>(const PlaneRows&);
template void mask_annulus<PKM_INSTRUCTION_SET>(const AnnulusLines&, std::size_t, std::uint64_t*);

}  // namespace pkm::crr_cru
