// Surveys of a plan, also where the held coordinate takes a set of values.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Mechanism::prepare, but a plan with SurveyPlan::held_values gives the surveys at all of them as one: samples in the
/// order of the values, weights and volume divided by their number. Throws as Mechanism::prepare.
std::unique_ptr<const Surveyor> prepare_survey(const Mechanism& mechanism, const SurveyPlan& plan,
                                               const Demand& demand);

}  // namespace pkm
