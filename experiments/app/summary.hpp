// What a study found, for people and for programs.
#pragma once

#include <string>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

/// Best design beside the baseline and published results, active bounds, stages, time.
std::string summary_text(const StudyContents& contents, const Study& study);

/// The object of `pkmopt show --json`.
Json summary_json(const StudyContents& contents);

}  // namespace pkm
