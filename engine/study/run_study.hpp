// Runs a study: its stages one after the other, checkpoints on the way, and what is worked out at the end. New studies,
// interrupted ones and finished ones that are to be extended take the same path: a stage always starts from nothing,
// and recorded evaluations are served before new ones are made.
//
// Of several ranks (engine/core/ranks.hpp) each runs the same stages on the same table; only evaluations are shared
// out. Rank 0 alone reads, locks and writes the study, talks, and decides after each generation whether to go on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"
#include "engine/study/extension.hpp"
#include "engine/study/progress.hpp"
#include "engine/study/stop_request.hpp"

namespace pkm {

/// Version of the behaviour of optimisers and surveys: a study is continued only by a program of the same one. Raise it
/// with every change that changes the evaluations that a seed leads to.
inline constexpr std::int64_t kAlgorithms = 3;

struct ProgramVersion {
  std::string version, revision;
};

struct RunOptions {
  int threads = 0;                   ///< of each rank, as for team_size(); 0: as ranks::threads() says
  std::optional<double> time_limit;  ///< [s] of this run; the study then stops early with a checkpoint
  ProgramVersion program;
};

struct RunOutcome {
  StudyContents contents;
  /// Why the run stopped before the study's end ("SIGINT", "time limit"); "" when the study is finished.
  std::string stopped;
  double seconds = 0;                 ///< of this run
  std::int64_t evaluations = 0;       ///< made by this run, replayed ones not counted
  double checkpoint_share = 0;        ///< of the run time, first and final write not counted
  double parallel_efficiency = 0;     ///< evaluation time over threads times wall time of the evaluations
  std::string team;                   ///< "2 threads", "4 ranks x 16 threads"
  double exchange_share = 0;          ///< of the run time, spent by rank 0 in messages, waiting included; one rank: 0
  std::vector<std::string> warnings;  ///< sentences for the user; also in the file
};

/// The last write of a run failed: what it has found is here, and not in its file.
class UnwrittenOutcome : public StorageError {
 public:
  UnwrittenOutcome(const std::string& why, RunOutcome found) : StorageError(why), outcome(std::move(found)) {}
  RunOutcome outcome;
};

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

/// What the ranks after the first do in a program of several: they take part in the runs that rank 0 begins, print and
/// write nothing, and return the exit code that it dismisses them with.
int take_part(const Catalogues& catalogues, const ProgramVersion& program);
/// Rank 0, at the program's end: the others end too.
void dismiss_ranks(int exit_code);

/// The study that a file holds, with its seed.
/// @param changes  to look at it otherwise
Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes = {});

}  // namespace pkm
