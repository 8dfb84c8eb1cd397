// The study that a study file holds, for commands that read it. All of them treat a file alike whose text and records
// differ (engine/storage/README.md).
#pragma once

#include <optional>
#include <string>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

/// The study of `file`, which holds `contents`. Prints one warning where the file records other values than its text
/// gives. Throws StorageError where they cannot be of one study, ConfigError where this program cannot read the text.
Study recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                     const StudyChanges& changes = {});

/// The same; none where that throws, and then `why`.
std::optional<Study> find_recorded_study(const StudyContents& contents, const std::string& file, const Session& session,
                                         std::string& why);

}  // namespace pkm
