// (3CRR/R)&CRU and Quadrupteron: feasible cells of parallel lines as bit masks, with one row of words for each line.
// Finds the cells in an annulus, kLanes lines per SIMD batch, and counts the cells in intersections of rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::crr_cru {

/// Parallel lines of cells and an annulus. A plain struct, so that kernels share no inline code with files that are
/// compiled for another instruction set.
struct AnnulusLines {
  double lower, step, cells;  ///< lower bound, cell size and number of cells of every line
  const double* across;       ///< position of each line normal to the lines, padded to a multiple of kLanes
  std::size_t lines;
  double center_along, center_across;  ///< centre of the annulus: position along the lines and normal to them
  double in2, out2;                    ///< squared inner and squared outer radius of the annulus
};

/// Clears the bits of all cells outside the annulus, i.e. exactly those for which the floating-point comparison
/// in2 <= (across - center_across)^2 + (cell - center_along)^2 <= out2 is false.
/// @param rows  one row of bits for each line, each of `words` words
template <InstructionSet set>
void mask_annulus(const AnnulusLines& lines, std::size_t words, std::uint64_t* rows);

/// Feasible cells of a plane with the coordinates u and v as bit masks. The cell (u, v) is feasible if three bits are
/// set: bit u of u_row, bit v of v_row, and bit v of the row with index u of v_at_u.
struct PlaneRows {
  const std::uint64_t *u_row, *v_row, *v_at_u;
  /// Number of cells along u and along v; number of 64-bit words per row of v_at_u.
  std::size_t u_cells, v_cells, words;
};

struct PlaneTally {
  std::int64_t cells;  ///< number of feasible cells
  bool touches;        ///< true if a feasible cell is the first or the last one along u or v
};

template <InstructionSet set>
PlaneTally tally(const PlaneRows& rows);

}  // namespace pkm::crr_cru
