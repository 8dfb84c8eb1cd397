// (3CRR/R)&CRU and Quadrupteron: which cells of lines lie in a ring, kLanes lines side by side, as rows of bits; and
// how many cells rows of bits have in common.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::crr_cru {

/// Parallel lines of cells and a ring. Nothing but numbers, so that kernels share no code with files that are compiled
/// for another instruction set.
struct RingLines {
  double lower, step, cells;  ///< of the axis along the lines
  const double* place;        ///< the lines' coordinate across; whole lanes
  std::size_t lines;
  double center, across;  ///< of the ring, along the lines and across them
  double in2, out2;       ///< squared radii
};

/// Takes out of each line's row of bits, `words` long, the cells that are not in the ring: the same cells for which
/// in2 <= (place - across)^2 + (centre of the cell - center)^2 <= out2 is false, one by one.
template <InstructionSet set>
void keep_ring(const RingLines& lines, std::size_t words, std::uint64_t* rows);

/// One plane of cells: a column along v has the bits of `of_v` that its own row has, where `of_u` has its bit.
struct PlaneRows {
  const std::uint64_t *of_u, *of_v, *at_u;  ///< at_u: a row of `words` for each u
  std::size_t u_cells, v_cells, words;
};

/// How many cells there are, and whether some are the first or the last along u or v.
struct PlaneTally {
  std::int64_t cells;
  bool touches;
};

template <InstructionSet set>
PlaneTally tally(const PlaneRows& rows);

}  // namespace pkm::crr_cru
