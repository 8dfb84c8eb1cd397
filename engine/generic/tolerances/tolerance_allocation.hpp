// Tolerance allocation: tolerances t_i of minimum cost sum_i c_i / t_i under linear constraints, as a convex program.
//
// The stationary point of the Lagrangian is t_i = sqrt(c_i / sum_r lambda_r a_ri). The multipliers lambda are found by
// the multiplicative iteration lambda_r <- lambda_r (a_r . t) / b_r.
//
// Reference: K. W. Chase, W. H. Greenwood, B. G. Loosli, L. F. Hauglund, "Least cost tolerance allocation for
// mechanical assemblies with automated process selection", Manufacturing Review 3 (1990), for the reciprocal cost
// model.
#pragma once

#include <vector>

namespace pkm::generic {

/// A linear constraint of the tolerances: sum_i coefficients[i] t_i <= bound, with coefficients >= 0 that are not all
/// 0, and bound > 0.
struct ToleranceRow {
  std::vector<double> coefficients;
  double bound = 0;
};

/// Tolerances t_i of approximately minimum cost sum_i c_i / t_i that satisfy all rows. Every tolerance must have a
/// positive coefficient in at least one row.
/// @param costs  c_i > 0
std::vector<double> allocate_tolerances(const std::vector<double>& costs, const std::vector<ToleranceRow>& rows);

}  // namespace pkm::generic
