// Hybrid robot: the feasible cells of columns along x, in SIMD batches of kLanes values of z.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/accelerators/hybrid/limbs.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::hybrid {

/// The columns along x at one beta. A plain struct, so that kernels share no inline code with files that are compiled
/// for another instruction set.
struct ColumnsAtBeta {
  Product<double> C, Q, P, L, H;  ///< for each of these curves that bound x, the radicand of its square root
  double sign, lo_C, hi_C;        ///< limb C: sign of n3, and the constants of its two bounds of x
  double z_high, hole_end;        ///< maximum z of all columns; maximum z at which the feasible x has a hole
  double x_lower, x_step, cells;
  /// For each column: its z, and the range [left, right] of x that limbs A and B allow; padded to a multiple of kLanes.
  const double *z, *left, *right;
  std::size_t first_z, end_z;  ///< columns exist for the indices [first_z, end_z) of z
};

/// Indices of the feasible cells along x, one element per z: cells [first, hole) and [after, end); all are whole
/// numbers.
struct CellRuns {
  std::vector<double> first, hole, after, end;
};

struct CellTally {
  double cells;  ///< number of feasible cells
  bool touches;  ///< true if a feasible cell is the first or the last of its column
};

/// Computes the runs of feasible cells along x for the z indices [first_z, end_z). The number of computed columns is
/// rounded up to a multiple of kLanes.
template <InstructionSet set>
CellTally fill(const ColumnsAtBeta& columns, CellRuns& runs);

}  // namespace pkm::hybrid
