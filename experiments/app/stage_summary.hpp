// Summary of a stage as text and as JSON. For solvers: the multistart runs, the local optima that they reached,
// first-order optimality and sensitivities. For a Pareto front: its extreme points, knees and quality indicators, and a
// selection of its points.
#pragma once

#include <string>

#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Text of a table of the multistart runs of a stage, best final design first, with a number for each different local
/// optimum; "" if the stage has no such runs.
std::string starts_text(const ProblemRecord& problem, const StageRecord& stage);
/// Text on first-order optimality, multipliers and sensitivities of a stage's best design; "" if the stage did not
/// compute them.
std::string optimality_text(const ProblemRecord& problem, const StageRecord& stage);
/// Text on the Pareto front of a stage; "" if it has none. Points are numbered from 1, as in `pkmopt evaluate --front`.
std::string front_text(const ProblemRecord& problem, const StageRecord& stage);

Json starts_json(const ProblemRecord& problem, const StageRecord& stage);
Json optimality_json(const OptimalityRecord& record);
/// JSON with all points of the front, and its quality indicators after each generation.
Json front_json(const ProblemRecord& problem, const StageRecord& stage);

/// The value of a variable: the name of a choice, or the number with its unit.
std::string variable_text(const ProblemRecord& problem, std::size_t variable, double value);
/// The value of a variable: the name of a choice, or the number in a given unit, without the name of the unit.
std::string variable_text(const ProblemRecord& problem, std::size_t variable, double value, const DisplayUnit& unit);
Json variable_json(const ProblemRecord& problem, std::size_t variable, double value);

/// The design, objectives, constraints and other values of an evaluation, by name.
Json row_json(const ProblemRecord& problem, const EvaluationTable& table, std::size_t row);

}  // namespace pkm
