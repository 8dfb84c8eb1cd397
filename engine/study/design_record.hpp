// Single designs, evaluated with everything that a study asks for.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

DesignRecord evaluated(const DesignProblem& problem, std::span<const double> parameters);

/// Rounding may leave the bounds, or what the mechanism is defined for: said in `reason`, and in the latter case
/// nothing is evaluated.
DesignRecord evaluated_rounded(const DesignProblem& problem, const std::vector<double>& parameters);

/// Adds bounds of this gap to the record of a design that could be evaluated. It fails where its exact volume lies
/// outside of them. Throws Stopped.
void add_certain(const DesignProblem& problem, double gap, DesignRecord& record);

}  // namespace pkm
