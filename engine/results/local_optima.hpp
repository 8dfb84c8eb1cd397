// The local optima that the multistart runs of a solver stage reached.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Indices of the multistart runs, sorted by their final designs, the best first; if there are several objectives, in
/// the order of the runs.
std::vector<std::size_t> order_by_result(const ProblemRecord& problem, const StageRecord& stage);

/// Number of the local optimum that each multistart run reached, 1 for the best; 0 if the run did not converge to a
/// feasible first-order optimum, or if there are several objectives. Final designs that are equal in every variable to
/// 1/1000 of its range are the same optimum.
std::vector<std::size_t> number_optima(const ProblemRecord& problem, const StageRecord& stage);

}  // namespace pkm
