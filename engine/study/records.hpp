// From a study to the records of its file, and back.
#pragma once

#include <string>
#include <vector>

#include "engine/core/refusal.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Header and problem of a study that has not begun.
StudyContents new_contents(const Study& study);

/// The study that a file holds, with its seed. Throws StorageError where the file's records cannot be those of the
/// study that its text describes, as of a forged file.
/// @param changes  to look at it otherwise
Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes = {});

/// The problem of a study that goes on, as this program records it. A parameter that the mechanism has gained since the
/// study was begun is added. Throws std::invalid_argument with half a sentence where anything else has changed.
ProblemRecord continued_problem(const Study& study, const ProblemRecord& begun);

/// "name = value" per option.
std::vector<std::string> option_lines(const Options& options);

}  // namespace pkm
