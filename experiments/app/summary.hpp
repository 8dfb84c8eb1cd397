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
/// @param diagnosis  added at the end; std::nullopt: the study found something
std::string summary_text(const StudyContents& contents, const Study& study, const std::optional<Diagnosis>& diagnosis);

/// The reasons of a diagnosis, one line each.
std::string reasons_text(const std::vector<Reason>& reasons);

/// The object of `pkmopt show --json`.
Json summary_json(const StudyContents& contents, const std::optional<Diagnosis>& diagnosis, const Failures& failures);

}  // namespace pkm
