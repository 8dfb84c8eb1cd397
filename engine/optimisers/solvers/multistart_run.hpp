// State of one multistart run: its start design, evaluations, recorded evaluations and outcome.
#pragma once

#include <string>
#include <vector>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

struct StartRun {
  StartDesign start;
  EvaluationTable table;     ///< evaluations of this run so far
  EvaluationTable recorded;  ///< recorded evaluations of an earlier run, which are replayed
  bool ended = false;
  bool is_local = false;      ///< this rank runs it
  StartOutcome outcome = {};  ///< rows count from 0
  std::string warning = {};

  /// Evaluations to be stored in a checkpoint: the record, until the replay has passed its end.
  const EvaluationTable& checkpoint_table() const {
    return !ended && recorded.size() > table.size() ? recorded : table;
  }
};

/// Creates the runs of a stage, from the start designs of its input and then from Sobol points, with their recorded
/// evaluations.
std::vector<StartRun> make_start_runs(const SolverPlan& plan, const StageInput& input);

}  // namespace pkm
