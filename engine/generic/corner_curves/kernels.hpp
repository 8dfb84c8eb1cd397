// SIMD kernels of Chebyshev series and of concurrence functions. Their arguments are numbers only, so that kernels
// share no code with files that are compiled for another instruction set.
#pragma once

#include <cstddef>

#include "engine/core/instruction_set.hpp"

namespace pkm::generic::corner_curves {

inline constexpr std::size_t kNodes = 32;   ///< number of nodes of Chebyshev interpolation
inline constexpr std::size_t kPoints = 16;  ///< number of points that series_at_points() evaluates at once

/// Computes the coefficients of an interpolant from its values at the nodes. @param table  T_k at node n < kNodes/2:
/// even k, then odd k, by rows of kNodes
template <InstructionSet set>
void transform(const double* table, const double* values, double* coefficients);

/// Restricts a series to [-1, 0] and [0, 1]. @param table  coefficients of T_k on [0, 1], by rows of kNodes
/// @param terms  number of coefficients c that are used; further ones, up to a multiple of kLanes, are set to 0
template <InstructionSet set>
void restrict_to_halves(const double* table, const double* c, std::size_t terms, double* lower, double* upper);

/// Values of `count` series, each with kNodes coefficients, of which `terms` are used, at kPoints places.
/// @param values  receives kPoints values for each series, one series after the other
template <InstructionSet set>
void series_at_points(const double* const* series, std::size_t count, std::size_t terms, const double* points,
                      double* values);

/// Three curves by their equations a |p|^2 + b . p + c = 0: for each curve the values of b_x, b_y and c at the kNodes
/// nodes.
struct ConcurrenceArguments {
  const double *first[3], *second[3], *third[3];
  /// Coefficient a of the second and of the third curve: 1 for a circle, 0 for a line.
  double second_share, third_share;
};

/// The concurrence function (boundary_curve.hpp) at the nodes; the first curve is a circle.
/// @return  the maximum magnitude of the radical centre's homogeneous coordinates
template <InstructionSet set>
double concurrence_at_nodes(const ConcurrenceArguments& curves, double* values);

}  // namespace pkm::generic::corner_curves
