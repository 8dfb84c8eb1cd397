// Single designs, evaluated with everything that a study asks for.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @param certain  gap of bounds that its exact volume has to be within; none: nobody asks
DesignRecord evaluated(const DesignProblem& problem, std::span<const double> parameters,
                       std::optional<double> certain = {});

/// Rounding may leave the bounds, or what the mechanism is defined for: said in `reason`, and in the latter case
/// nothing is evaluated.
DesignRecord evaluated_rounded(const DesignProblem& problem, const std::vector<double>& parameters,
                               std::optional<double> certain);

}  // namespace pkm
