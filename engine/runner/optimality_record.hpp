// First-order optimality (KKT conditions) of a stage's best design, in the form in which the study file stores it.
#pragma once

#include <optional>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return KKT residual, active bounds and constraints, and sensitivities with respect to all parameters; empty if the
/// study has several objectives, the stage has no best design, or its evaluation failed
std::optional<OptimalityRecord> optimality_record(const Study& study, const StageRecord& stage);

}  // namespace pkm
