// State of one multistart run: its start design, evaluations, recorded evaluations and outcome.
#pragma once

#include <string>
#include <vector>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

struct MultistartRun {
  StartDesign start;
  EvaluationTable table;     ///< evaluations of this run so far
  EvaluationTable recorded;  ///< recorded evaluations of an earlier run, which are replayed
  bool ended = false;
  bool is_local = false;      ///< true if this rank executes the run
  StartOutcome outcome = {};  ///< row numbers refer to `table`
  std::string warning = {};

  /// Evaluations to be stored in a checkpoint: `recorded` until all of it has been replayed, then `table`.
  const EvaluationTable& checkpoint_table() const {
    return !ended && recorded.size() > table.size() ? recorded : table;
  }
};

/// Creates the runs of a stage, from the start designs of its input and then from Sobol points, with their recorded
/// evaluations.
std::vector<MultistartRun> make_multistart_runs(const SolverPlan& plan, const StageInput& input);

}  // namespace pkm
