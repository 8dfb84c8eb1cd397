// Starting points of a stage: designs found by earlier stages, the baseline, or designs given in the study.
#pragma once

#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return the starting points of a stage. Solvers select them by their options (start, starts, basin_radius, designs):
/// - by default the best design of the earlier stages; in a first stage the allowed design nearest to the baseline, or
///   the centre of the bounds if there is no baseline;
/// - "best-of-basins": see basins() in stage_starts.cpp;
/// - "pareto": points spread over the front of the last stage that has found one;
/// - designs given in the study.
/// Other optimisers get the best design of the earlier stages. In a first stage they get no starting point, except
/// sweeps, which get the baseline.
std::vector<StartDesign> start_designs(const Study& study, const Stage& stage, const StudyContents& contents);

/// The starting points of a stage before which nothing was evaluated, as above.
/// @param first  the baseline or the centre of the bounds
std::vector<StartDesign> first_start_designs(const DesignSpace& space, const Stage& stage, const StartDesign& first);

/// @return ranges of the objectives on the front found by earlier stages (or the best design's objectives), and its
/// reference point; empty for a single objective
PreviousFront previous_front(const Study& study, const StudyContents& contents);

}  // namespace pkm
