// Starting points of a stage: designs found by earlier stages, the baseline, or designs given in the study.
#pragma once

#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return the starting points of a stage. A solver selects them by its option `start`:
/// - "best" (default): the best design of the earlier stages;
/// - "best-of-basins": the best designs that have no better design in a neighbourhood;
/// - "pareto": points spread over the front of the last stage that has found one; if there is none, the best design;
/// - "none": no designs of earlier stages.
/// The designs given by the option `designs` are added to them. Other optimisers get the best design of the earlier
/// stages. If nothing was evaluated before the stage, see first_start_designs().
std::vector<StartDesign> start_designs(const Study& study, const Stage& stage, const StudyContents& contents);

/// The starting points of a stage before which nothing was evaluated: the best of the designs taken from another study
/// (a solver with start = "best-of-basins" and other optimisers get several of them). If there are none, solvers and
/// sweeps start from `base`. A solver with start = "none" gets neither the designs of another study nor `base`. For
/// solvers, the designs given by the option `designs` are added.
/// @param base   the baseline or the centre of the bounds
/// @param given  designs of another study, best first
std::vector<StartDesign> first_start_designs(const DesignSpace& space, const Stage& stage, const StartDesign& base,
                                             const std::vector<StartDesign>& given = {});

/// The allowed design nearest to the baseline; without a baseline the centre of the bounds.
std::vector<double> baseline_or_centre(const Study& study);

/// The best designs of a study. If a stage has found a front: points spread over the last front, in its order.
/// Otherwise the best designs that have no better design in a neighbourhood, best first. A design consists of the
/// values of that study's variables.
std::vector<StartDesign> distinct_best_designs(const StudyContents& contents, std::size_t limit);

/// @return for several objectives: their ranges on the front found by earlier stages (or the objectives of the best
///         design), and the reference point of this front; empty for a single objective
PreviousFront previous_front(const Study& study, const StudyContents& contents);

}  // namespace pkm
