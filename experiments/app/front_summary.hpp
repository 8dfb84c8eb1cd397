// A stage's trade-off in words and JSON: its ends, its knees, a choice of its points, its indicators.
#pragma once

#include <string>

#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Points count from 1, as in `pkmopt evaluate --front`. "" where the stage has no front.
std::string front_text(const ProblemRecord& problem, const StageRecord& stage);
/// Every point, and the indicators after each generation.
Json front_json(const ProblemRecord& problem, const StageRecord& stage);

/// The starts of a stage that began on a front: every objective before and after.
std::string front_starts_text(const ProblemRecord& problem, const StageRecord& stage);

}  // namespace pkm
