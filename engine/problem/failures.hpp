// Why evaluations of a study failed. Files do not store the reasons: they follow from the designs, some of which are
// evaluated again.
#pragma once

#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Failed evaluations with reasons that differ in their numbers only.
struct FailureReason {
  std::string example;  ///< the reason of the first
  std::size_t count = 0;
};

struct Failures {
  std::size_t evaluations = 0, failed = 0;
  std::size_t examined = 0;            ///< of the failed: evaluated again
  std::vector<FailureReason> reasons;  ///< of these, the most frequent first
};

/// Evaluates at most 64 failed designs again, at equal distances in their order; fewer where they took more than a
/// second when they were first evaluated.
/// @param problem  that they belong to; null: no reason is known
Failures failures_in(const std::vector<const EvaluationTable*>& tables, const DesignProblem* problem);

/// "12 of 480 evaluations failed: 9 times motor-torque: the motion cycle leaves the reach of the mechanism at t = 0.1
/// s, for example; once .."; "" where none failed.
std::string failures_text(const Failures& failures);

}  // namespace pkm
