// Stop reasons of stages, and outcomes of the single runs of a multistart solver stage.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include "engine/problem/evaluation.hpp"

namespace pkm {

enum class StopReason {
  generations,
  evaluations,
  target,
  stall,
  tolerance,
  exhausted,
  interrupted,
  time,
  failed,
  starts,  ///< every multistart run has ended
};

/// The reason in words, for the terminal and the study file: "generation limit", ...
std::string_view words(StopReason reason);

/// Outcome of one multistart run of a solver. Row numbers refer to the evaluation table of the stage.
struct StartOutcome {
  std::string origin;          ///< origin of the starting point: "best so far", "Sobol point 3"
  std::int64_t first_row = 0;  ///< row of the run's first evaluation, i.e. of the starting point
  std::int64_t rows = 0;       ///< number of evaluations of the run
  std::int64_t end_row = 0;    ///< row of the result: the best evaluated design, including starting and final point
  std::string stop;            ///< reason why the run ended: "converged", "evaluation limit", "time limit" or "failed"
  std::string message;         ///< message of the solver
  /// KKT residual at the end, the norm of the projected gradient (see optimality.hpp); NaN without derivatives.
  double optimality = 0;
};

/// A multistart run whose evaluations are buffered. The runs are concurrent, but their evaluations are appended to the
/// evaluation table of the stage in start order. The evaluations of a run are therefore buffered until every earlier
/// run has ended.
struct UnmergedRun {
  std::int64_t number = 0;              ///< index of the run in its stage, from 0
  EvaluationTable table;                ///< evaluations of the run so far
  std::optional<StartOutcome> outcome;  ///< outcome of the run, set once it has ended; row numbers refer to `table`
};

}  // namespace pkm
