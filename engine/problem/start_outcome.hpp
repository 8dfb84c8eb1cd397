// How stages and the starts of solvers end.
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
  starts,  ///< every start has come to its own end
};

/// "generation limit", ...: the words of the screen and the study file.
std::string_view words(StopReason reason);

/// How one start of a solver ended.
struct StartOutcome {
  std::string origin;          ///< where the start came from: "best so far", "Sobol point 3"
  std::int64_t first_row = 0;  ///< of its evaluations; this one is the start itself
  std::int64_t rows = 0;       ///< evaluations made
  std::int64_t end_row = 0;    ///< what is kept: the best of start, all that was seen and what the solver returned
  std::string stop;            ///< "converged", "evaluation limit", "time limit" or "failed"
  std::string message;         ///< what the solver said
  /// Norm of the projected gradient at the end (see optimality.hpp); NaN where the stage has no derivatives.
  double optimality = 0;
};

/// What is known of a start of a solver whose evaluations cannot follow those before it yet: starts are at work side by
/// side, and an earlier one has not ended.
struct StartAhead {
  std::int64_t number = 0;              ///< 0 is the stage's first start
  EvaluationTable table;                ///< its evaluations so far
  std::optional<StartOutcome> outcome;  ///< once it has ended; its rows count from 0
};

}  // namespace pkm
