// One start of a solver stage, with what is known of it.
#pragma once

#include <string>
#include <vector>

#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

struct StartRun {
  StartDesign from;
  EvaluationTable table;     ///< its evaluations so far, which a solver adds to
  EvaluationTable recorded;  ///< those on record; they are not less than they were
  bool ended = false;
  bool here = false;          ///< this rank works on it
  StartOutcome outcome = {};  ///< rows from 0
  std::string warning = {};

  /// What a checkpoint should hold of it: the record until it has been overtaken.
  const EvaluationTable& known() const { return !ended && recorded.size() > table.size() ? recorded : table; }
};

/// All starts of a stage: the designs that it is given, then Sobol points; with what is on record of them.
std::vector<StartRun> starts_of_stage(const SolverPlan& plan, const StageInput& input);

}  // namespace pkm
