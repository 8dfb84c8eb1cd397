// The local optima that the multistart runs of a solver stage reached.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Indices of the multistart runs, sorted by their final designs, the best first; if there are several objectives, in
/// the order of the runs.
std::vector<std::size_t> order_by_result(const ProblemRecord& problem, const StageRecord& stage);

/// Upper limit of the KKT residual (engine/optimisers/solvers/optimality.hpp) of a design that counts as an optimum.
inline constexpr double kMaxResidualOfOptimum = 1e-4;

/// Number of the local optimum that each start reached, 1 for the best; 0 if the start did not converge to a feasible
/// first-order optimum, or if there are several objectives. Final designs are the same optimum if they are equal in
/// every variable to 1/1000 of its range, or if they have the same objective and differ only in variables that have no
/// influence on the objective at the best design.
std::vector<std::size_t> number_optima(const ProblemRecord& problem, const StageRecord& stage);

}  // namespace pkm
