// What `run` and `resume` have in common.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/problem/verdict.hpp"
#include "engine/study/run_study.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

struct RunningArguments {
  int threads = 0;
  std::string time;
  bool quiet = false;
};

/// Declares --threads.
void add_threads(CLI::App& command, int& threads);
/// Declares --threads, --time and --quiet.
void add_running_options(CLI::App& command, RunningArguments& arguments);

/// Threads of this rank.
int threads_of(const RunningArguments& arguments);
/// For the estimate before a run, and for what progress says of the time left.
RunCost measured_cost(const Study& study, const Session& session);

/// Warns of more threads than cores.
RunOptions run_options(const RunningArguments& arguments, const Session& session);
/// A bar or lines on stderr; nothing when quiet.
std::unique_ptr<Progress> make_progress(const RunningArguments& arguments);

/// How a run ended, also where what it found could not be written.
struct RunEnd {
  RunOutcome outcome;
  std::optional<std::string> unwritten = {};  ///< why
};
RunEnd end_of_run(const std::function<RunOutcome()>& run);

/// Sets the exit code where the study found nothing, and says so in a line on stderr when quiet.
void conclude(const std::optional<Verdict>& verdict, const RunningArguments& arguments, Session& session);

/// The end of a run, and what the program's exit code is for it. Throws StorageError after what it has to tell where
/// that is not in the file.
void print_end(const RunEnd& end, const Study& study, const std::string& file, const RunningArguments& arguments,
               Session& session);

}  // namespace pkm
