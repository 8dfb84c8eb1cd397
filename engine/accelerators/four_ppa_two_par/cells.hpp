// 4PPa-2PaR: the feasible cells of columns along z, in SIMD batches of kLanes values of theta.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::four_ppa_two_par {

/// The columns of the first x of a grid at kLanes consecutive thetas. A plain struct, so that kernels share no inline
/// code with files that are compiled for another instruction set.
struct ColumnsAtThetas {
  double a, b, l_u, l_d, d, L0;        ///< as in Geometry
  double sin_par_min, cos_theta_min;   ///< as in Limits
  double x_min, x_max, z_low, z_high;  ///< as in Ranges
  double y;
  double x_lower, x_step, z_lower, z_step;  ///< lower bounds and steps of the grid
  double z_cells;
  const double *sines, *cosines;  ///< sines and cosines of kLanes thetas
  std::int64_t thetas;            ///< number of thetas with cells, from the first
  std::int64_t columns;           ///< number of x, from the first
};

/// Numbers of feasible cells, by theta.
struct CellTally {
  double cells[kLanes], in_first[kLanes], in_last[kLanes];  ///< in all columns, in the first one, in the last one
  bool lowest, highest;  ///< whether a column contains the lowest or the highest cell
};
/// Counts the cells with x indices [from, to).
template <InstructionSet set>
CellTally tally(const ColumnsAtThetas& columns, std::int64_t from, std::int64_t to);

/// Cells [first, end) of z, at index x * kLanes + theta, for the x indices [x_begin, x_end); there are none elsewhere.
struct ColumnBlock {
  std::int64_t x_begin = 0, x_end = 0;
  std::vector<double> first, end;  ///< integers; end <= first: none
};
template <InstructionSet set>
void fill(const ColumnsAtThetas& columns, ColumnBlock& block);

}  // namespace pkm::four_ppa_two_par
