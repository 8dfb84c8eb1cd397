// Tables that a study, or an option of the command line, adds to a mechanism: quantities, their limits, errors, drives.
#pragma once

#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/toml.hpp"

namespace pkm {

/// The additions of a study's document, a copy of which they own.
StudyAdditions study_additions(const TomlValue& study, const std::string& file_name);

/// [accuracy] joint_error, as an option gives it; null if there is none.
/// @param lists  one error for all joints, or NAME=ERROR, separated by commas
StudyAdditions joint_error_addition(const std::vector<std::string>& lists);

}  // namespace pkm
