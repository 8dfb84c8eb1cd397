// How long a run will still take: from how fast its stage goes, from what an evaluation of later stages costs, and from
// what its final steps cost.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/setup/study.hpp"

namespace pkm {

/// What a study's evaluations take, each on one thread, and its final steps [s]; 0: unknown.
struct RunCost {
  double plain = 0, with_derivatives = 0, final_steps = 0;
  double exact_limit = 0;  ///< s, of exact values of the final designs that were not measured to their end; 0: were

  static constexpr double kLongest = 2;  ///< of an evaluation: measuring ends there
};

/// Measures it: an evaluation in the middle of the design space, and of the baseline, the longer one. Exact values that
/// take longer than some tenths of a second are only known by their limit.
RunCost cost_of_run(const Study& study);

/// What the stages of a study take at most, by their limits of evaluations [s].
double seconds_of_stages(const Study& study, const RunCost& cost, int threads);

class TimeLeft {
 public:
  TimeLeft(const Study& study, const RunCost& cost, int threads);

  /// After evaluations of a stage. Of a solver's stage, which may end long before its limit, an upper bound that never
  /// grows.
  /// @param left     evaluations that the stage will still make, at most
  /// @param made     evaluations of this run so far, replayed ones not counted
  /// @param seconds  of this run
  /// @return [s]; none in the first second, and while nothing has been evaluated
  std::optional<double> after(std::size_t stage, std::int64_t left, std::int64_t made, double seconds);

 private:
  struct Sample {
    double seconds;
    std::int64_t made;
  };

  std::vector<double> stages_;   ///< s, of whole stages
  std::vector<bool> is_bound_;   ///< of stages: their limits are seldom reached
  double final_steps_;           ///< s, exact values that were not measured at their limit
  std::size_t stage_ = 0;        ///< at work
  Sample begin_ = {0, 0};        ///< of the stage at work
  std::deque<Sample> samples_;   ///< its last ones
  Sample last_ = {0, 0};         ///< of any stage
  std::optional<double> bound_;  ///< of the stage at work
};

}  // namespace pkm
