// Tables that a study, or an option of the command line, adds to a mechanism: quantities, their limits, errors, drives.
#pragma once

#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/toml.hpp"

namespace pkm {

/// Reads the document of a study whose quantities, limits of quantities, errors and drives are added to a mechanism.
/// The result owns a copy of the document.
StudyAdditions study_additions(const TomlValue& study, const std::string& file_name);

/// Parses the option --joint-error: one bound for all joints, or NAME=BOUND, separated by commas.
/// @return bounds >= 0 of all joints [SI]; 0 for joints that are not named
std::vector<double> parse_joint_errors(const MechanismInfo& info, const std::vector<std::string>& lists);

/// A document whose only table is [accuracy], with the key joint_error from the values of the option --joint-error.
StudyAdditions joint_error_addition(const MechanismInfo& info, const std::vector<std::string>& lists);

}  // namespace pkm
