// Statistics of failed evaluations by reason. Study files do not store the reasons: a sample of the failed designs is
// evaluated again to find them.
#pragma once

#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Failed evaluations whose reasons differ only in their numbers.
struct FailureReason {
  std::string example;  ///< reason of the first of the failed evaluations, with its numbers
  std::size_t count = 0;
};

struct Failures {
  std::size_t evaluations = 0, failed = 0;
  std::size_t examined = 0;            ///< number of failed designs that were evaluated again
  std::vector<FailureReason> reasons;  ///< reasons of the examined designs, the most frequent first
};

/// Evaluates up to 64 failed designs again, equally spaced in their order; fewer if their first evaluations took more
/// than one second in total.
/// @param problem  the problem of the tables; null: designs are counted without reasons
Failures collect_failures(const std::vector<const EvaluationTable*>& tables, const DesignProblem* problem);

/// "12 of 480 evaluations failed: 9 because, for example, motor-torque: the motion cycle leaves the reach of the
/// mechanism at t = 0.1 s; 3 because .."; "" if none failed.
std::string failures_text(const Failures& failures);

}  // namespace pkm
