// pkmopt run: what it is told, and one run of one study.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/app/running.hpp"

namespace pkm {

struct RunArguments {
  std::string study, output;
  bool resume = false, force = false;
  std::optional<std::int64_t> seed;
  int seeds = 1;
  StudyChanges changes;
  RunningArguments common;
};

/// The files that a study was read from: no output may be one of them.
std::vector<std::string> inputs_of(const Study& study);

bool exists(const std::string& file);

/// Runs the study into a file, or goes on with the one that is there, as the arguments ask for. Throws StorageError.
RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments,
                   const RunOptions& options, Session& session, Progress& progress);

/// The same study over several seeds: a file and a line each, then the spread.
void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, RunOptions options,
               Session& session);

/// Says what the evaluations and the final steps will cost at most.
void print_estimate(const Study& study, const RunCost& cost, int seeds, int threads_of_rank);

}  // namespace pkm
