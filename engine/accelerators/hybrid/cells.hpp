// Hybrid robot: the feasible cells of columns along x, in SIMD batches of kLanes values of z.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::hybrid {

/// The columns at one beta. A plain struct, so that kernels share no inline code with files that are compiled for
/// another instruction set.
struct ColumnsAtBeta {
  Product<double> C, Q, P, L, H;  ///< curves of the slice: bounds of x, squared
  double sign, lo_C, hi_C;        ///< limb C: sign of n3, constants of its bounds of x
  double z_high, hole_end;        ///< maximum z of columns, and of the hole
  double x_lower, x_step, cells;
  const double *z, *left, *right;  ///< z, and the range of x that limbs A and B allow there; padded
  std::size_t first_z, end_z;      ///< range of indices of z
};

/// Feasible cells of x for each z, as integers: [first, hole) and [after, end).
struct CellRuns {
  std::vector<double> first, hole, after, end;
};

struct CellTally {
  double cells;  ///< number of feasible cells
  bool touches;  ///< true if a feasible cell is the first or the last of its column
};

/// Computes the runs for indices of z [first_z, end_z), and for some more up to a multiple of kLanes.
template <InstructionSet set>
CellTally fill(const ColumnsAtBeta& columns, CellRuns& runs);

}  // namespace pkm::hybrid
