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

/// The problem of a study, as this program records it.
ProblemRecord problem_of(const Study& study);

/// The study that a file holds, with its seed. Where the file records other values than its text gives in this program,
/// because somebody changed them or the program has other defaults, it has the recorded values and `differences`.
/// Throws StorageError, without the file's name, where the records cannot be those of the study that the text
/// describes, or the text is not the one that the study was begun with.
/// @param changes  to look at it otherwise
Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes = {});

/// The study of the file at `path` for a run that continues it: one without differences. Throws StorageError.
Study study_to_continue(const StudyContents& contents, const std::string& path, const Catalogues& catalogues);

/// "name = value" per option.
std::vector<std::string> option_lines(const Options& options);

}  // namespace pkm
