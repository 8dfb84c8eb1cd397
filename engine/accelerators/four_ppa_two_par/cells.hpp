// 4PPa-2PaR: the feasible cells of columns, at kLanes thetas side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::four_ppa_two_par {

/// The columns (along z) of the first x of a grid at kLanes neighbouring thetas. Nothing but numbers, so that kernels
/// share no code with files that are compiled for another instruction set.
struct ColumnsAtThetas {
  double a, b, l_u, l_d, d, L0;        ///< as in Geometry
  double sin_par_min, cos_theta_min;   ///< as in Limits
  double x_min, x_max, z_low, z_high;  ///< as in Ranges
  double y;
  double x_lower, x_step, z_lower, z_step;  ///< of the grid
  double z_cells;
  const double *sines, *cosines;  ///< of kLanes thetas
  std::int64_t thetas;            ///< those from this one on have no cells
  std::int64_t columns;           ///< how many x, from the first
};

/// How many cells are feasible, by theta.
struct CellTally {
  double cells[kLanes], in_first[kLanes], in_last[kLanes];  ///< of all columns, of the first, of the last one
  bool lowest, highest;                                     ///< a column reaches the lowest, the highest cell of z
};
/// @param from, to  the x indices to count
template <InstructionSet set>
CellTally tally(const ColumnsAtThetas& columns, std::int64_t from, std::int64_t to);

/// Cells [first, end) of z, at [x index * kLanes + theta]; there are none outside of the x indices [x_begin, x_end).
struct ColumnBlock {
  std::int64_t x_begin = 0, x_end = 0;
  std::vector<double> first, end;  ///< whole numbers; end <= first: none
};
template <InstructionSet set>
void fill(const ColumnsAtThetas& columns, ColumnBlock& block);

}  // namespace pkm::four_ppa_two_par
