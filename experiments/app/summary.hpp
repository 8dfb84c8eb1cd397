// What a study found, for people and for programs.
#pragma once

#include <string>

#include "engine/problem/failures.hpp"
#include "engine/problem/verdict.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Best design beside the baseline and published results, active bounds, stages, time; the verdict, if there is one.
std::string summary_text(const StudyContents& contents, const Study& study, const std::optional<Verdict>& verdict);

/// The reasons of a verdict, a line each.
std::string reasons_text(const std::vector<Reason>& reasons);

/// The object of `pkmopt show --json`.
Json summary_json(const StudyContents& contents, const std::optional<Verdict>& verdict, const Failures& failures);

}  // namespace pkm
