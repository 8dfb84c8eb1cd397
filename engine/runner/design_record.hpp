// Evaluates single designs completely: all objectives, margins and outputs, and certified bounds of the volume.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Evaluates one design.
/// @param parameters  values of all parameters of the mechanism
DesignRecord evaluate_design(const DesignProblem& problem, std::span<const double> parameters);

/// Evaluates a design whose variables have been rounded to the steps given in the study. DesignRecord::reason lists the
/// variables that rounding has moved out of their bounds. If the mechanism is not defined for the rounded parameters,
/// nothing is evaluated and the status is `failed`.
DesignRecord evaluate_design_after_rounding(const DesignProblem& problem, const std::vector<double>& parameters);

/// Adds certified bounds of the volume to the record, unless its evaluation failed. Sets the status to failed if the
/// computed volume lies outside them. Throws Stopped after a stop request.
/// @param gap  requested gap of the bounds: upper minus lower bound, relative to their mean
void add_certified_bounds(const DesignProblem& problem, double gap, DesignRecord& record);

}  // namespace pkm
