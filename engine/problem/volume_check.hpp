// Check of the workspace volume computed by columns against certified bounds (interval branch and bound). It detects
// that the sampled columns have missed a component of the workspace, if the component is larger than the gap of the
// bounds.
#pragma once

#include <functional>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Computes certified bounds of the workspace volume of a design, as `pkmopt certify` does. If the volume of the
/// report, plus or minus its error estimate, lies outside them, the report's status becomes `failed` with the reason.
/// Throws std::invalid_argument if the mechanism has no bounds.
/// @param report  evaluation by columns of a design that did not fail
/// @param gap     relative gap of the bounds at which to stop
/// @param stop    polled during the computation; true: return the bounds reached so far
VolumeBounds verify_volume(const DesignProblem& problem, DesignReport& report, double gap,
                           const std::function<bool()>& stop = {});

}  // namespace pkm
