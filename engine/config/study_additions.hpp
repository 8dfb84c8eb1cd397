// Tables that a study, or an option of the command line, adds to a mechanism: quantities, their limits, errors, drives.
#pragma once

#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/toml.hpp"

namespace pkm {

/// The additions in the document of a study. The result owns a copy of the document.
StudyAdditions study_additions(const TomlValue& study, const std::string& file_name);

/// The key joint_error of [accuracy], from the values of a command-line option; null if the lists are empty.
/// @param lists  one error for all joints, or NAME=ERROR, separated by commas
StudyAdditions joint_error_addition(const std::vector<std::string>& lists);

}  // namespace pkm
