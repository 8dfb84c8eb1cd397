// How stages and the starts of solvers end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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

}  // namespace pkm
