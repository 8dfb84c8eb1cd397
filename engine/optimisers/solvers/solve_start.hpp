// One start of a solver stage, from its first evaluation to its end.
#pragma once

#include <optional>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

/// Runs the solver, anew where it gives up short of the optimum, and tries what lies on bounds and margins beside its
/// end. None: interrupted.
/// @param trials  of the start, which they have evaluated
/// @param table  their evaluations
/// @param measurable  false: several objectives are measured from the start, whose evaluation failed
std::optional<StartOutcome> solve_start(const Solver& solver, Trials& trials, const EvaluationTable& table,
                                        std::uint64_t seed, bool measurable);

}  // namespace pkm
