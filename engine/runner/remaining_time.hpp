// Estimate of the remaining time of a run: from the evaluation rate of the current stage, and from the measured costs
// of an evaluation in later stages and of the final steps.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/runner/run_cost.hpp"

namespace pkm {

/// @return maximum time of all stages together, computed from their evaluation limits [s]
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
  /// @return remaining time [s]; std::nullopt in the first second, and as long as there are no evaluations
  std::optional<double> update(std::size_t stage, std::int64_t left, std::int64_t made, double seconds);

 private:
  /// The number of evaluations that this run has made at a given time.
  struct Sample {
    double seconds;
    std::int64_t made;
  };

  std::vector<double> stages_;   ///< for each stage, its maximum time [s]
  std::vector<bool> is_solver_;  ///< for each stage, whether it is a solver stage, whose evaluation limit is rarely
                                 ///< reached
  double final_steps_;           ///< maximum time of the final steps [s]
  std::size_t stage_ = 0;        ///< index of the current stage
  Sample begin_ = {0, 0};        ///< time and evaluations at the beginning of the current stage
  std::deque<Sample> samples_;   ///< times and evaluations at recent updates in the current stage
  Sample last_ = {0, 0};         ///< time and evaluations at the last update
  /// Upper bound of the remaining time found so far [s], in a solver stage; otherwise std::nullopt.
  std::optional<double> bound_;
};

}  // namespace pkm
