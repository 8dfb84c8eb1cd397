// Hybrid robot: the feasible cells of columns along x, at kLanes heights side by side.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::hybrid {

/// The columns at one beta. Nothing but numbers, so that kernels share no code with files that are compiled for
/// another instruction set.
struct ColumnsAtBeta {
  Product<double> C, Q, P, L, H;  ///< as in Section: the ends of x squared
  double sign, lo_C, hi_C;        ///< of limb C
  double z_high, hole_end;        ///< no columns above the first, no hole above the second
  double x_lower, x_step, cells;
  const double *z, *left, *right;  ///< heights, and what limbs A and B leave of x there; whole lanes
  std::size_t first_z, end_z;      ///< indices of the heights
};

/// Cells of x at each height, whole numbers: [first, hole) and [after, end).
struct CellRuns {
  std::vector<double> first, hole, after, end;
};

/// How many there are, and whether a column reaches its lowest or its highest cell.
struct CellTally {
  double cells;
  bool touches;
};

/// Fills the runs of heights [first_z, end_z) and, up to whole lanes, of some beyond.
template <InstructionSet set>
CellTally fill(const ColumnsAtBeta& columns, CellRuns& runs);

}  // namespace pkm::hybrid
