// What a run of a study is told, and what it comes to.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Version of the behaviour of optimisers and surveys: a study is continued only by a program of the same one. Raise it
/// with every change that changes the evaluations that a seed leads to.
inline constexpr std::int64_t kAlgorithms = 6;

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

}  // namespace pkm
