// From a study to the records of its file.
#pragma once

#include <optional>

#include "engine/core/refusal.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Header and problem of a study that has not begun.
StudyContents new_contents(const Study& study);

/// Why a file's records cannot be those of the study that its text describes, as of a forged file.
Refusal text_against_record(const Study& study, const StudyContents& contents);

/// The problem of a study that goes on, as this program records it. A parameter that the mechanism has gained since the
/// study was begun is added. Throws std::invalid_argument with half a sentence where anything else has changed.
ProblemRecord continued_problem(const Study& study, const ProblemRecord& begun);

/// "name = value" per option.
std::vector<std::string> option_lines(const Options& options);

/// The multiple of `step` next to `value`, as the decimal number that a reader expects: 0.7, not 0.7000000000000001.
double rounded_to(double value, double step);

/// First-order optimality of a stage's best design, with the sensitivities to every parameter. None where the design
/// has no derivatives (its evaluation failed).
std::optional<OptimalityRecord> optimality_record(const Study& study, const StageRecord& stage);

/// What is worked out at the end, from the best design so far. Empty records where nothing was evaluated. A note says
/// why a voxel study knows no values on exact columns that its mechanism has; they are NaN where they are read from a
/// region on voxels. Asked to stop, certain bounds end early, `stopped`.
FinalRecord final_record(const Study& study, StudyContents& contents);

}  // namespace pkm
