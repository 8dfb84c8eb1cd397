// SIMD kernels of Chebyshev series and of concurrence functions. Their arguments are numbers only, so that kernels
// share no code with files that are compiled for another instruction set.
#pragma once

#include <cstddef>

#include "engine/core/instruction_set.hpp"

namespace pkm::generic::corner_curves {

inline constexpr std::size_t kNodes = 32;   ///< number of nodes of Chebyshev interpolation
inline constexpr std::size_t kPoints = 16;  ///< number of points that series_at_points() evaluates at once

/// Computes the Chebyshev coefficients of the interpolant that has given values at the nodes.
/// @param table  row n, of kNodes numbers: values of T_k at node n < kNodes/2, first for even k, then for odd k
template <InstructionSet set>
void transform(const double* table, const double* values, double* coefficients);

/// Restricts a Chebyshev series with the coefficients c to [-1, 0] (`lower`) and to [0, 1] (`upper`).
/// @param table  row k, of kNodes numbers: coefficients of T_k on [0, 1]
/// @param terms  number of coefficients of c that are used; of the results, those that follow, up to a multiple of
///               kLanes, are set to 0
template <InstructionSet set>
void restrict_to_halves(const double* table, const double* c, std::size_t terms, double* lower, double* upper);

/// Computes the values of `count` Chebyshev series at kPoints points. Each series has kNodes coefficients, of which the
/// first `terms` are used.
/// @param values  receives the kPoints values of the first series, then those of the second, and so on
template <InstructionSet set>
void series_at_points(const double* const* series, std::size_t count, std::size_t terms, const double* points,
                      double* values);

/// The transpose of series_at_points(): adds to coefficients[i][k] the sum over the points q of weights[i][q] T_k(x_q),
/// for `count` functions i.
/// @param points   the points x_q; at most kPoints
/// @param weights  for each function, kPoints numbers
/// @param terms    number of coefficients of each function, a multiple of kLanes
template <InstructionSet set>
void add_adjoints_of_series(const double* points, std::size_t number_of_points, const double* weights,
                            std::size_t count, std::size_t terms, double* const* coefficients);

/// values[n] = sum over k < size of factors[k] table[k][n], for n < size, a multiple of kLanes.
/// @param table  rows of kNodes numbers
template <InstructionSet set>
void combine_rows(const double* table, const double* factors, std::size_t size, double* values);

/// Three boundary curves by their equations a |p|^2 + b . p + c = 0. For each curve, three arrays contain the values of
/// b_x, b_y and c at the kNodes nodes; a = 1 for the first curve.
struct ConcurrenceArguments {
  const double *first[3], *second[3], *third[3];
  /// Coefficient a of the second and of the third curve: 1 for a circle, 0 for a line.
  double second_share, third_share;
};

/// Computes the values at the nodes of the function that is 0 where three curves meet in one point (concurrence() in
/// boundary_curve.hpp). The first curve is a circle.
/// @return  maximum magnitude of the homogeneous coordinates of the radical centre of the curves
template <InstructionSet set>
double concurrence_at_nodes(const ConcurrenceArguments& curves, double* values);

}  // namespace pkm::generic::corner_curves
