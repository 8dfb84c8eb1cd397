// Chebyshev interpolation on [-1, 1] with a fixed number of nodes (Trefethen, "Approximation Theory and Approximation
// Practice", SIAM 2013, chapters 3 and 18).
//
// An analytic function is represented by its values at the roots of T_32, or by its coefficients
// f(x) = c[0] T_0(x) + ... + c[31] T_31(x). Since |T_k| <= 1, the sum of |c[k]| bounds |f|, also on a subinterval
// after restriction: this is how roots are excluded (root_isolation.hpp).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "engine/generic/corner_curves/kernels.hpp"

namespace pkm::generic::corner_curves {

inline constexpr double kUnitRoundoff = 0x1p-53;

/// Values of a function at the kNodes Chebyshev nodes in [-1, 1], or the kNodes coefficients of its Chebyshev series.
struct alignas(64) Samples : std::array<double, kNodes> {};

/// The Chebyshev nodes in [-1, 1] in descending order. @param nodes  their number: 8, 16, 24 or kNodes
const Samples& chebyshev_nodes(std::size_t nodes = kNodes);

/// Computes the coefficients of the Chebyshev series that has the given values at the nodes.
void to_coefficients(const Samples& values, Samples& coefficients);

/// Converts derivatives of a quantity with respect to Chebyshev coefficients to its derivatives with respect to values
/// at `nodes` nodes (8, 16, 24 or kNodes), by the transpose of the interpolation. Valid for functions for which `nodes`
/// coefficients are sufficient.
void transpose_to_values(const Samples& by_coefficients, std::size_t nodes, Samples& by_values);

/// The number of leading coefficients that are significant, at least 1: the magnitudes of the others, up to coefficient
/// `terms`, have a sum of at most `size`.
std::size_t significant_terms(const Samples& coefficients, std::size_t terms, double size);

/// Value of c[0] T_0(x) + ... + c[terms - 1] T_(terms - 1)(x), by Clenshaw's recurrence.
inline double evaluate_series(const double* c, std::size_t terms, double x) {
  double next = 0, after = 0;
  for (std::size_t k = terms; k-- > 1;) {
    const double here = c[k] + 2 * x * next - after;
    after = next;
    next = here;
  }
  return c[0] + x * next - after;
}

/// Restricts a Chebyshev series to [-1, 0] (`lower`) and to [0, 1] (`upper`): computes the coefficients of two series,
/// each in a variable of its own in [-1, 1].
/// @param terms  number of coefficients of each series; further elements are not read and remain undefined
void restrict_to_halves(const Samples& coefficients, std::size_t terms, Samples& lower, Samples& upper);

/// Computes the values of three Chebyshev series at kPoints points.
/// @param values  receives the kPoints values of the first series, then those of the second and of the third
void evaluate_at_points(const std::array<Samples, 3>& series, std::size_t terms, const double* points, double* values);

/// Computes the coefficients of the derivative of a Chebyshev series; their number is terms - 1.
void differentiate_series(const double* coefficients, std::size_t terms, double* derivative);

}  // namespace pkm::generic::corner_curves
