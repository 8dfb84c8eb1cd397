// What a stage found, as text and as JSON: of solvers their starts, the optima these ended in, first-order optimality
// and sensitivities; of a trade-off its ends, its knees, a choice of its points, its indicators.
#pragma once

#include <string>

#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// A table of a stage's starts, best end first, distinct optima numbered; "" for a stage without starts.
std::string starts_text(const ProblemRecord& problem, const StageRecord& stage);
/// Optimality, multipliers and sensitivities of a stage's best design; "" where it has none.
std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage);
/// Points count from 1, as in `pkmopt evaluate --front`. "" where the stage has no front.
std::string front_text(const ProblemRecord& problem, const StageRecord& stage);

Json starts_json(const ProblemRecord& problem, const StageRecord& stage);
Json optimality_json(const OptimalityRecord& record);
/// Every point, and the indicators after each generation.
Json front_json(const ProblemRecord& problem, const StageRecord& stage);

/// An evaluation: its values by their names.
Json row_json(const ProblemRecord& problem, const EvaluationTable& table, std::size_t row);

}  // namespace pkm
