// First-order optimality as a study's file keeps it.
#pragma once

#include <optional>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Of a stage's best design, with the sensitivities to every parameter. None where the design has no derivatives (its
/// evaluation failed).
std::optional<OptimalityRecord> optimality_record(const Study& study, const StageRecord& stage);

}  // namespace pkm
