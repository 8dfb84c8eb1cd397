// Multistart local search with a solver library (NLopt, Ipopt): concurrent runs from several start designs.
//
// A run depends only on its start design and number. It has its own table, and the rows are merged into the stage table
// in start order (multistart_merger.hpp), so that the result equals that of consecutive runs. When a stage is resumed,
// finished runs are restored from the record, and interrupted ones replay their recorded evaluations through the
// solver. If a solver deviates from its record (on another processor, or with another version of the library), that run
// is restarted with a warning.
//
// With several MPI ranks, each rank claims the next unclaimed run and posts its result to rank 0; at the end of the
// stage all ranks exchange all results. Only rank 0 reports progress and decides when to stop.
#pragma once

#include <memory>

#include "engine/optimisers/solvers/nonlinear_program.hpp"

namespace pkm {

/// Result of one solver call.
struct SolverResult {
  bool converged = false;
  std::string message;        ///< the solver's status message
  std::vector<double> point;  ///< final point in the unit cube; empty if there is none
};

/// A local or global optimisation algorithm of a library.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Runs the solver. The best recorded evaluation is the result of a multistart run: the returned point is only a
  /// candidate, and the returned status matters only if the KKT residual does not show convergence.
  /// @param start  start point in the unit cube
  virtual SolverResult solve(NonlinearProgram& program, const std::vector<double>& start, std::uint64_t seed) const = 0;
};

struct SolverPlan {
  std::shared_ptr<const Solver> solver;
  StartLimits limits;           ///< limits of each multistart run
  std::int64_t starts = 1;      ///< maximum number of start designs that are taken from the stage's input
  std::int64_t multistart = 0;  ///< number of additional runs, which start from Sobol points
  bool concurrent = true;       ///< true if several threads may call the solver library at once
  Detail detail = Detail::complete;
  Scalarisation scalarisation = {};  ///< how several objectives are combined; its ranges are set from the stage's input
  std::string objective = {};        ///< epsilon-constraint method: name of the minimised objective; "": the first
};

std::unique_ptr<Optimiser> make_solver_stage(SolverPlan plan);

/// Capabilities of a solver stage. With start = "pareto" it handles several objectives and needs a front.
Capabilities solver_capabilities(const Options& options, bool constraints, bool gradient);

/// Specifications of the options common to all solver stages.
std::vector<OptionSpec> solver_options();
/// Reads the options common to all solver stages; the caller sets SolverPlan::solver. Throws std::invalid_argument for
/// contradictory options.
SolverPlan solver_plan(const Options& options);
OptionSpec tighten_option();

}  // namespace pkm
