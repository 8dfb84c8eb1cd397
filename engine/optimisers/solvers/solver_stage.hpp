// What the stages of the solver libraries share: starts side by side, each within its limits, the best of each kept,
// resumed by replay.
//
// A start depends on nothing but its design and its number, so it has a table of its own, and its rows join the stage's
// table in the order of the starts: what the stage comes to is the same as one after the other. A start that had ended
// when a run was killed is taken from the record as it is; those at work are replayed through the solver. Where a
// solver leaves the recorded path (another processor, another version of the library), that one start begins anew, and
// the user is told.
//
// Of several ranks each takes the next start that nobody has, and posts to rank 0 what it came to; at the stage's end
// all have everything. Rank 0 alone reports, and says when to stop.
#pragma once

#include <memory>

#include "engine/optimisers/solvers/trials.hpp"

namespace pkm {

/// How a solver came back.
struct SolverEnd {
  bool converged = false;
  std::string message;        ///< its own words
  std::vector<double> point;  ///< in the unit cube
};

/// One run of one solver.
class Solver {
 public:
  virtual ~Solver() = default;
  /// @param from  point of the unit cube to start at
  /// Neither trusts nor reports anything but points: what they are worth is in the trials.
  virtual SolverEnd solve(Trials& trials, const std::vector<double>& from, std::uint64_t seed) const = 0;
};

struct SolverPlan {
  std::shared_ptr<const Solver> solver;
  TrialLimits limits;  ///< of each start
  std::int64_t starts = 1;
  std::int64_t multistart = 0;  ///< Sobol points besides the designs given
  bool side_by_side = true;     ///< the solver may work in several threads at once
  Detail detail = Detail::complete;
  Scalarisation scalarisation = {};  ///< of several objectives; its extents come with the stage's input
  std::string objective = {};        ///< epsilon-constraint: the one that is to gain; "": the first
};

std::unique_ptr<Optimiser> make_solver_stage(SolverPlan plan);

/// Stages that start from points of a front handle several objectives, and need a front.
Capabilities solver_capabilities(const Options& options, bool constraints, bool gradient);

/// The options that every solver stage has, and the plan that they describe (its solver is left to the caller). Throws
/// std::invalid_argument with a sentence when they leave no start.
std::vector<OptionSpec> solver_options();
SolverPlan solver_plan(const Options& options);
OptionSpec tighten_option();

}  // namespace pkm
