// Where a stage begins: from what the stages before it found, or from what the study says.
#pragma once

#include <vector>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// The designs that a stage is given. Solvers choose them by their options (start, starts, basin_radius, designs);
/// others get the best so far. A first stage that works on one design gets the baseline, moved into the space, or the
/// middle of the ranges.
/// Stages that need a front get points that are spread over it: of the last stage that has found one.
std::vector<StartDesign> start_designs(const Study& study, const Stage& stage, const StudyContents& contents);

/// Extents and reference of the front that a stage would start from; empty for problems with one objective.
KnownFront known_front(const Study& study, const StudyContents& contents);

}  // namespace pkm
