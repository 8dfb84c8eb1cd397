// The exact volume of a design beside certain bounds of it: what the samples of columns could overlook is found, or is
// no more than the bounds leave open.
#pragma once

#include <functional>

#include "engine/problem/design_problem.hpp"

namespace pkm {

/// Bounds the volume of a design's workspace by intervals, as `pkmopt certify` does. The report fails where its volume,
/// more or less its error estimate, lies outside. Throws std::invalid_argument where there are no bounds.
/// @param report  of a design that could be evaluated, by exact columns
/// @param stop    asked now and then: whether what is known so far will do; none: it will not
VolumeBounds check_volume(const DesignProblem& problem, DesignReport& report, double gap,
                          const std::function<bool()>& stop = {});

}  // namespace pkm
