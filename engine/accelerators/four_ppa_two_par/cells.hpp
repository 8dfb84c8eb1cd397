// 4PPa-2PaR: the feasible cells of columns along z, in SIMD batches of kLanes values of theta.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::four_ppa_two_par {

/// The columns along z at the first x values of a grid, for kLanes consecutive values of theta. A plain struct, so that
/// kernels share no inline code with files that are compiled for another instruction set.
struct ColumnsAtThetas {
  double a, b, l_u, l_d, d, L0;        ///< lengths of the design, named as in README.md [m]
  double sin_par_min, cos_theta_min;   ///< minimum of sin(beta_1 + beta_2) and of cos(theta)
  double x_min, x_max, z_low, z_high;  ///< range of x_j; maximum and minimum of -z_cj for unlimited stroke
  double y;
  double x_lower, x_step, z_lower, z_step;  ///< lower bounds and steps of the grid
  double z_cells;
  const double *sines, *cosines;  ///< sines and cosines of kLanes thetas
  std::int64_t thetas;            ///< number of thetas that have cells; they come first in the arrays
  std::int64_t columns;           ///< number of columns at each theta, beginning with the first x of the grid
};

/// Numbers of feasible cells; element k of each array belongs to theta number k of the batch.
struct CellTally {
  /// Number of cells in all columns, in the first and in the last column.
  double cells[kLanes], in_first[kLanes], in_last[kLanes];
  bool lowest, highest;  ///< true if a column contains the lowest (highest) cell of the grid along z
};
/// Counts the feasible cells of the columns with x indices [from, to).
template <InstructionSet set>
CellTally tally(const ColumnsAtThetas& columns, std::int64_t from, std::int64_t to);

/// Feasible cells along z of the columns with x indices [x_begin, x_end). The element for a column has the index x *
/// kLanes + theta. All other columns have no feasible cells.
struct ColumnBlock {
  std::int64_t x_begin = 0, x_end = 0;
  std::vector<double> first, end;  ///< the feasible cells of a column are [first, end); integers; none if end <= first
};
template <InstructionSet set>
void fill(const ColumnsAtThetas& columns, ColumnBlock& block);

}  // namespace pkm::four_ppa_two_par
