// Measured and estimated times of the parts of a study, before it is run.
#pragma once

#include <string>
#include <vector>

#include "engine/config/study.hpp"

namespace pkm {

/// Estimated times that parts of a study take [s]; 0: unknown.
struct RunCost {
  double plain = 0, with_derivatives = 0;  ///< time of an evaluation without and with derivatives, on one thread
  double final_steps = 0;                  ///< time of those final steps that could be measured (see final_record.hpp)

  /// A final step that takes too long to be measured.
  struct LongStep {
    std::string what;    ///< noun phrase
    double seconds = 0;  ///< its maximum time
  };
  std::vector<LongStep> long_steps = {};

  double all_final_steps() const;

  static constexpr double kTimeLimit = 2;  ///< maximum time of the measurement of an evaluation [s]
};

/// Measures the costs of a study. Evaluates the centre of the design space and the baseline or, if both fail, the first
/// of some Sobol points that does not fail, and uses the longest of these times. Exact values and certificates of the
/// final designs that take longer than some tenths of a second are not completed, but estimated.
RunCost measure_run_cost(const Study& study);

}  // namespace pkm
