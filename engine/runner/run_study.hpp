// Runs a new study, resumes an interrupted one, or extends a finished one, and writes the results to the study file.
// All three use class Run (run.hpp).
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "engine/config/study.hpp"
#include "engine/runner/extension.hpp"
#include "engine/runner/progress.hpp"
#include "engine/runner/run_outcome.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"

namespace pkm {

/// Runs a new study and writes it to `path`. Throws StorageError, in particular if `path` exists and `overwrite` is
/// false.
RunOutcome run_study(const Study& study, const std::string& path, bool overwrite, const RunOptions& options,
                     Progress& progress);

/// A study file that this process has locked and read in order to resume it. While an instance exists, SIGINT, SIGTERM
/// and SIGHUP request a stop if it handles signals.
struct LockedStudy {
  /// Locks and reads the file. Throws StorageError.
  /// @param handles_signals  true: the instance handles signals
  explicit LockedStudy(std::string file, bool handles_signals = true)
      : stop_request(handles_signals ? std::make_unique<StopRequest>() : nullptr),
        path(std::move(file)),
        lock(path),
        contents(read_study(path)) {}

  const std::unique_ptr<StopRequest> stop_request;
  std::string path;
  StudyLock lock;
  StudyContents contents;
};

/// Makes the external functions that a study calls callable, by options.functions if it is set, otherwise by Python
/// worker processes. They must be the recorded functions. Throws ConfigError, StorageError and Stopped.
/// @param path  path of the file from which the study was read
void connect_functions(const Study& study, const StudyContents& contents, const std::string& path,
                       const RunOptions& options);

/// Resumes a study, or extends a finished one. Throws StorageError if the file cannot be read or written, if it was
/// written with another algorithm version, or if its recorded evaluations are not reproduced; ConfigError if its
/// problem cannot be built or the extension is invalid.
/// @param locked  the study; its contents are moved to the outcome
RunOutcome resume_study(LockedStudy& locked, const Catalogues& catalogues, const ExtensionRequest& extension,
                        const RunOptions& options, Progress& progress);
inline RunOutcome resume_study(const std::string& path, const Catalogues& catalogues, const ExtensionRequest& extension,
                               const RunOptions& options, Progress& progress) {
  LockedStudy locked(path, options.handles_signals);
  return resume_study(locked, catalogues, extension, options, progress);
}

}  // namespace pkm
