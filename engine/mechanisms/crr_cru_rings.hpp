// (3CRR/R)&CRU and Quadrupteron: which cells of lines lie in a ring, kLanes lines side by side; and how many cells rows
// of bits have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Of each line, the cells [first, end) whose distance is at most the outer radius, and of them [hole_first, hole_end)
/// that are nearer than the inner one. Whole numbers; empty where the end is not greater. As long as whole lanes.
struct RingCells {
  std::vector<double> first, end, hole_first, hole_end;
};

/// The same cells that (place - across)^2 + (centre of the cell - center)^2 <= out2 and < in2 find one by one.
template <InstructionSet set>
void cells_in_ring(const RingLines& lines, RingCells& cells);

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
