// Column surveys of described mechanisms.
#pragma once

#include <memory>

#include "engine/mechanism/plan.hpp"
#include "engine/mechanism/surveyor.hpp"
#include "engine/mechanisms/described/evaluation.hpp"

namespace pkm::described {

/// Throws std::invalid_argument with a sentence when the description cannot serve the plan.
std::unique_ptr<const Surveyor> prepare_columns(const Mechanism& mechanism, const Evaluation& evaluation,
                                                const SurveyPlan& plan, const ColumnOptions& columns,
                                                const Demand& demand);

/// Why no survey of the mechanism has columns; "": its usual one has.
std::string why_no_columns(const Mechanism& mechanism, const Evaluation& evaluation);

}  // namespace pkm::described
