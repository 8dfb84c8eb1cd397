// (3CRR/R)&CRU and Quadrupteron: which cells of lines lie in rings, kLanes lines side by side.
#pragma once

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::crr_cru {

/// Lines of cells along one axis, each with a ring. Nothing but numbers, so that kernels share no code with files that
/// are compiled for another instruction set.
struct RingLines {
  double lower, step, cells;  ///< of the axis
  double center[kLanes], away[kLanes], in2[kLanes],
      out2[kLanes];  ///< rings' centres on and off the lines, squared radii
};

/// Of each line, the cells [first, end) whose distance is at most the outer radius, and of them [hole_first, hole_end)
/// that are nearer than the inner one. Whole numbers; empty where the end is not greater.
struct RingCells {
  double first[kLanes], end[kLanes], hole_first[kLanes], hole_end[kLanes];
};

/// The same cells that away^2 + (centre of the cell - center)^2 <= out2 and < in2 find one by one.
template <InstructionSet set>
RingCells cells_in_rings(const RingLines& lines);

}  // namespace pkm::crr_cru
