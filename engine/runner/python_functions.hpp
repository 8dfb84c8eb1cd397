// Connects the functions that a study calls (objectives of type "python") to the files that define them.
#pragma once

#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/runner/python_workers.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Starts worker processes for the functions of a study; does nothing if the study calls none or if they are connected
/// already. The file of a function is searched for relative to each of the `folders`, in this order. Throws ConfigError
/// if there is no such file or it does not define the function, StorageError if the file has changed, and Stopped after
/// a stop request.
/// @param recorded  the functions recorded in the study file to be resumed: the contents of their files must not have
///                  changed
/// @param threads   number of processes if the options do not specify a number
void start_python_workers(const Study& study, const std::vector<std::string>& folders,
                          const std::vector<FunctionRecord>& recorded, const PythonOptions& options, int threads);

/// Path of the folder that contains a file; "": the current folder.
std::string folder_of(const std::string& file);

/// The records of the functions of a study, which are stored in the study file. Throws std::logic_error if the
/// functions are not connected to files yet.
std::vector<FunctionRecord> function_records(const Study& study);

/// Throws StorageError if the file that defines one of the study's functions has another hash than the recorded one.
void expect_recorded_functions(const Study& study, const std::vector<FunctionRecord>& recorded);

}  // namespace pkm
