// Conversion between a Study (built from TOML text) and the contents of its study file. When a study is rebuilt from
// its file, the recorded numbers are compared with those that the text gives in this program version.
#pragma once

#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/core/unsupported.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return the contents of a new study file: provenance and problem, no stages
StudyContents new_contents(const Study& study);

/// @return the problem of a study as it is stored in the study file: all variables, objectives, constraints and values
ProblemRecord problem_record(const Study& study);

/// Rebuilds the study of a study file, with the recorded seed. If recorded values differ from those that the text gives
/// in this program (because the file was edited or default values have changed), the recorded values are used and
/// Study::differences lists them. Throws StorageError (without the file name) if the recorded problem is not the one
/// that the text describes, or if the text was changed after the study was started.
/// @param changes  changes to be applied to the study
Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes = {});

/// Rebuilds the study of a study file in order to resume it. Throws StorageError if the recorded problem or any
/// recorded value differs from that which the study's text gives, or if the text was changed after the study was
/// started.
/// @param path  path of the file, for messages
Study study_to_continue(const StudyContents& contents, const std::string& path, const Catalogues& catalogues);

/// @return for each option, the text "name = value"
std::vector<std::string> option_lines(const Options& options);

}  // namespace pkm
