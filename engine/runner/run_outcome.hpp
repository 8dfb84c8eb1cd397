// Options and results of a run of a study.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/runner/progress.hpp"
#include "engine/runner/python_workers.hpp"
#include "engine/runner/remaining_time.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Version of the numerical behaviour of optimisers and workspace analyses. A study is resumed only by a program of the
/// same version. To be increased with every change that alters the sequence of evaluations of a given seed.
inline constexpr std::int64_t kAlgorithms = 12;

/// Program version and arguments, which must be the same on all MPI ranks.
struct ProgramVersion {
  std::string version, revision;
  std::string arguments = {};  ///< command-line arguments as one line of text
};

struct RunOptions {
  /// Number of threads of each MPI rank; 0: OMP_NUM_THREADS if it is set, otherwise the number of cores for the rank.
  int threads = 0;
  /// Wall time of this run after which it stops with a checkpoint [s]; std::nullopt: unlimited.
  std::optional<double> time_limit;
  /// Function that returns true to stop the run with a checkpoint. It is called often, by any thread of the team. An
  /// empty function never stops.
  std::function<bool()> stop = {};
  /// Called after each new generation, on MPI rank 0, with the study as far as it has been computed; may be empty.
  std::function<void(const StudyContents&, const ProgressReport&)> observer = {};
  /// True if SIGINT, SIGTERM and SIGHUP request a stop. False if pkmopt is used as a library, which must not change the
  /// signal handling of the process.
  bool handles_signals = true;
  PythonOptions python = {};  ///< options of the Python workers, for studies that call Python functions
  /// If not null, it calls the external functions of a resumed study; otherwise Python worker processes do.
  std::shared_ptr<FunctionCaller> functions = {};
  ProgramVersion program;
  RunCost cost = {};  ///< measured costs, for the estimate of the remaining time in progress reports
};

struct RunOutcome {
  StudyContents contents;
  /// Reason for stopping before the end of the study ("SIGINT", "time limit", "request"); "" if the study is finished.
  std::string stopped;
  double seconds = 0;                 ///< wall time of this run [s]
  std::int64_t evaluations = 0;       ///< number of evaluations made by this run, without replayed ones
  double checkpoint_share = 0;        ///< share of the run time spent on checkpoints (first and final write excluded)
  double parallel_efficiency = 0;     ///< sum of the evaluation times / (number of threads * wall time of evaluating)
  std::string team;                   ///< number of threads as text, for example "2 threads" or "4 ranks x 16 threads"
  double exchange_share = 0;          ///< share of the run time that MPI rank 0 spent in messages, including waiting
  std::vector<std::string> warnings;  ///< warnings for the user, one sentence each; they are also in the study file
};

/// Exception for a failure of the final write of a run. It contains the results, which are not in the study file.
class UnwrittenOutcome : public StorageError {
 public:
  UnwrittenOutcome(const std::string& why, RunOutcome found) : StorageError(why), outcome(std::move(found)) {}
  RunOutcome outcome;
};

}  // namespace pkm
