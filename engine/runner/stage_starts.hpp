// Starting points of a stage: designs found by earlier stages, the baseline, or designs given in the study.
#pragma once

#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return the starting points of a stage. Solvers select them by their options (start, starts, basin_radius, designs):
/// - by default the best design of the earlier stages. In a first stage it is the best of the designs taken from
/// another
///   study (Study::starts); if there are none, the allowed design nearest to the baseline; without a baseline the
///   centre of the bounds;
/// - "best-of-basins": see basins() in stage_starts.cpp;
/// - "pareto": points spread over the front of the last stage that has found one;
/// - designs given in the study.
/// Other optimisers get the best design of the earlier stages or, in a first stage, the designs taken from another
/// study. If there are none, only sweeps get a starting point: the baseline.
std::vector<StartDesign> start_designs(const Study& study, const Stage& stage, const StudyContents& contents);

/// The starting points of a stage before which nothing was evaluated, as above.
/// @param base   the baseline or the centre of the bounds
/// @param given  designs of another study, best first
std::vector<StartDesign> first_start_designs(const DesignSpace& space, const Stage& stage, const StartDesign& base,
                                             const std::vector<StartDesign>& given = {});

/// The allowed design nearest to the baseline; without a baseline the centre of the bounds.
std::vector<double> baseline_or_centre(const Study& study);

/// The best designs of a study, best first: if a stage has found a front, points spread over the last front, else the
/// best designs of basins, no two of which are nearer than a given share of all ranges. The designs have the values of
/// the study's variables.
std::vector<StartDesign> distinct_best_designs(const StudyContents& contents, std::size_t limit);

/// @return ranges of the objectives on the front found by earlier stages (or the best design's objectives), and its
/// reference point; empty for a single objective
PreviousFront previous_front(const Study& study, const StudyContents& contents);

}  // namespace pkm
