// Non-negative least squares (NNLS): active-set method of Lawson and Hanson, "Solving Least Squares Problems" (1974),
// chapter 23.
#pragma once

#include <vector>

namespace pkm {

/// Minimises |A x - b| over x >= 0. Throws std::runtime_error if it does not converge.
/// @param columns  columns of A, each as long as b
/// @param enough   the iteration stops as soon as |A x - b| is at most this
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               const std::vector<double>& b, double enough = 0);

}  // namespace pkm
