// What solver stages found: their starts, the optima these ended in, first-order optimality and sensitivities.
#pragma once

#include <string>

#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// A table of a stage's starts, best end first, distinct optima numbered; "" for a stage without starts.
std::string starts_text(const ProblemRecord& problem, const StageRecord& stage);
/// Optimality, multipliers and sensitivities of a stage's best design; "" where it has none.
std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage);

Json starts_json(const ProblemRecord& problem, const StageRecord& stage);
Json optimality_json(const OptimalityRecord& record);

}  // namespace pkm
