// Estimate of the remaining time of a run: from the evaluation rate of the current stage, and from the measured costs
// of an evaluation in later stages and of the final steps.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/config/study.hpp"

namespace pkm {

/// Measured costs of a study [s]; 0: unknown.
struct RunCost {
  double plain = 0, with_derivatives = 0;  ///< an evaluation without and with derivatives, on one thread
  double final_steps = 0;                  ///< all final steps together (see final_record.hpp)
  /// Time limit of the exact values of the final designs if they were too slow to be measured; 0 otherwise.
  double exact_limit = 0;

  static constexpr double kTimeLimit = 2;  ///< an evaluation is measured for at most this time [s]
};

/// Measures the costs of a study: evaluates the centre of the design space and the baseline, and uses the longer of the
/// two times. The exact values of the final designs are measured only if they take less than some tenths of a second.
RunCost measure_run_cost(const Study& study);

/// @return maximum time of all stages, which follows from their evaluation limits [s]
double max_stage_seconds(const Study& study, const RunCost& cost, int threads);

class RemainingTime {
 public:
  RemainingTime(const Study& study, const RunCost& cost, int threads);

  /// Updates the estimate after evaluations of a stage. In a solver stage, which may end long before its evaluation
  /// limit, the estimate is an upper bound that never increases.
  /// @param stage    index of the stage
  /// @param left     maximum number of evaluations that the stage will still request
  /// @param made     number of evaluations of this run so far, excluding replayed ones
  /// @param seconds  time since the start of this run
  /// @return remaining time [s]; empty in the first second, and while there are no evaluations
  std::optional<double> update(std::size_t stage, std::int64_t left, std::int64_t made, double seconds);

 private:
  /// Number of evaluations that this run has completed at a given time.
  struct Sample {
    double seconds;
    std::int64_t made;
  };

  std::vector<double> stages_;   ///< maximum time of each stage [s]
  std::vector<bool> is_solver_;  ///< solver stages: their evaluation limit is rarely reached
  double final_steps_;           ///< maximum time of the final steps [s]
  std::size_t stage_ = 0;        ///< current stage
  Sample begin_ = {0, 0};        ///< beginning of the current stage
  std::deque<Sample> samples_;   ///< recent samples of the current stage
  Sample last_ = {0, 0};         ///< last sample
  std::optional<double> bound_;  ///< current solver stage: upper bound so far [s]
};

}  // namespace pkm
