// Summary of the results of a study, as text for people and as JSON for programs.
#pragma once

#include <string>

#include "engine/config/study.hpp"
#include "engine/problem/diagnosis.hpp"
#include "engine/problem/failures.hpp"
#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Stages and time, the best design compared with the baseline and published results, active constraints.
/// @param diagnosis  printed at the end; std::nullopt: the study found a feasible design
std::string summary_text(const StudyContents& contents, const Study& study, const std::optional<Diagnosis>& diagnosis);

/// Text of the reasons of a diagnosis, one line for each.
std::string reasons_text(const std::vector<Reason>& reasons);

/// The JSON object that `pkmopt show --json` prints.
Json summary_json(const StudyContents& contents, const std::optional<Diagnosis>& diagnosis, const Failures& failures);

}  // namespace pkm
