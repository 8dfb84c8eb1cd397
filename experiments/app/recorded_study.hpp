// Rebuilds the study from the contents of a study file. All commands that read study files use these functions, so that
// a file whose text and records differ is treated in the same way everywhere (docs/reference/study-file/versions.md).
#pragma once

#include <optional>
#include <string>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

/// Rebuilds the study from `contents`, the contents of `file`. If recorded values differ from those given by the
/// study's text, prints a warning and uses the recorded values. Throws StorageError if text and records cannot belong
/// to one study, and ConfigError if this program cannot read the text.
Study recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                     const StudyChanges& changes = {});

/// Rebuilds the study from `contents`, the contents of `file`; does not throw.
/// @param why  receives the reason if there is no study
/// @return std::nullopt if recorded_study() would throw
std::optional<Study> find_recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                                         std::string& why);

}  // namespace pkm
