// The report of one study beside its study file, for `run --live`.
#pragma once

#include <string>

#include "experiments/app/commands.hpp"

namespace pkm {

/// Path of the report beside a study file: study.html for study.h5.
std::string report_file_beside(const std::string& study_file);
/// Evaluates and writes the report beside a study file, and replaces the previous one. Throws if this build has no page
/// or the file cannot be read or written.
/// @return path of the report
std::string write_report_beside(const std::string& study_file, int threads, const Session& session);

}  // namespace pkm
