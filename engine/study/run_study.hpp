// Runs a study into its file. New studies, interrupted ones and finished ones that are to be extended take the same
// path, see run.hpp.
#pragma once

#include <string>
#include <utility>

#include "engine/setup/study.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"
#include "engine/study/extension.hpp"
#include "engine/study/progress.hpp"
#include "engine/study/run_outcome.hpp"
#include "engine/study/stop_request.hpp"

namespace pkm {

/// Runs a new study into `path`, which must not exist unless `overwrite`. Throws StorageError.
RunOutcome run_study(const Study& study, const std::string& path, bool overwrite, const RunOptions& options,
                     Progress& progress);

/// A study file that this process may go on with: locked, then read, once. Signals ask for a stop from then on.
struct HeldStudy {
  /// Throws StorageError.
  explicit HeldStudy(std::string file) : path(std::move(file)), lock(path), contents(read_study(path)) {}

  const StopRequest listen = {};
  std::string path;
  StudyLock lock;
  StudyContents contents;
};

/// Goes on with a study, whose contents become the outcome's. Throws StorageError, also when the file was written by a
/// program whose algorithms differ or its recorded evaluations do not repeat, and ConfigError when its problem cannot
/// be built or the extension does not fit.
RunOutcome resume_study(HeldStudy& held, const Catalogues& catalogues, const ExtensionRequest& extension,
                        const RunOptions& options, Progress& progress);
inline RunOutcome resume_study(const std::string& path, const Catalogues& catalogues, const ExtensionRequest& extension,
                               const RunOptions& options, Progress& progress) {
  HeldStudy held(path);
  return resume_study(held, catalogues, extension, options, progress);
}

}  // namespace pkm
