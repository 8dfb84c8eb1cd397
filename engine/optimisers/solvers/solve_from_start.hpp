// Complete solver run from one start design: repeated solver calls, polishing of the result and checks of convergence.
#pragma once

#include <optional>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

/// Runs the solver, restarts it where it stops before the optimum, and moves the result onto nearby bounds and
/// constraints.
/// @param program  the nonlinear program, with the start design evaluated
/// @param table  evaluations of `program`
/// @param start_evaluated  false if several objectives are to be scalarised relative to a start design whose evaluation
///   failed
/// @return the outcome of the run; nullopt if the run was interrupted
std::optional<StartOutcome> solve_from_start(const Solver& solver, NonlinearProgram& program,
                                             const EvaluationTable& table, std::uint64_t seed, bool start_evaluated);

}  // namespace pkm
