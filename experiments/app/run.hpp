// `pkmopt run`: its arguments, and the functions that run a study once or with several seeds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/app/running.hpp"

namespace pkm {

struct RunArguments {
  std::string study, output, start_from;
  bool resume = false, force = false;
  std::optional<std::int64_t> seed;
  int seeds = 1;
  StudyChanges changes;
  RunningArguments common;
};

/// The files that a study was read from, which no output may overwrite.
std::vector<std::string> input_files(const Study& study);

/// Returns true if the file exists. If that cannot be determined, it returns false; the attempt to open the file then
/// reports the error.
bool exists(const std::string& file);

/// Runs a study and writes its study file. With --resume, continues the study if the file exists. Throws StorageError.
RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments,
                   const RunOptions& options, Session& session, Progress& progress);

/// Runs a study with arguments.seeds consecutive seeds, writes a study file for each, and prints a table of the results
/// and their spread.
void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, RunOptions options,
               Session& session);

/// Prints an upper bound of the estimated time for all evaluations and the final steps.
void print_estimate(const Study& study, const RunCost& cost, int seeds, int threads_of_rank);

}  // namespace pkm
