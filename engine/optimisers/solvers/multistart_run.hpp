// State of one multistart run: its start design, evaluations, recorded evaluations and outcome.
#pragma once

#include <string>
#include <vector>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

struct MultistartRun {
  StartDesign start;
  EvaluationTable table;     ///< evaluations of this run so far
  EvaluationTable recorded;  ///< evaluations that an earlier, interrupted run recorded, and which are replayed
  bool ended = false;
  bool is_local = false;      ///< true if this MPI rank executes this run
  StartOutcome outcome = {};  ///< outcome of this run, with row numbers of its `table`
  std::string warning = {};

  /// Evaluations to be stored in a checkpoint: `recorded` until all of its rows have been replayed, afterwards `table`.
  const EvaluationTable& checkpoint_table() const {
    return !ended && recorded.size() > table.size() ? recorded : table;
  }
};

/// Creates the multistart runs of a stage, first from the start designs of its input, then from Sobol points, and
/// restores the recorded evaluations of each.
std::vector<MultistartRun> make_multistart_runs(const SolverPlan& plan, const StageInput& input);

}  // namespace pkm
