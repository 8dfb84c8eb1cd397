// Options and final output shared by the commands `run` and `resume`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/problem/diagnosis.hpp"
#include "engine/runner/run_study.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

struct RunningArguments {
  int threads = 0, workers = 0;
  std::string time;
  bool quiet = false;
};

/// Declares --threads.
void add_threads(CLI::App& command, int& threads);
/// Declares --workers.
void add_workers(CLI::App& command, int& workers);
/// Starts the processes for the Python functions of a study, if it calls any.
/// @param file  TOML file or study file; the Python functions are in its folder
void start_python(const Study& study, const std::string& file, int workers, int threads);
/// Declares --threads, --workers, --time and --quiet.
void add_running_options(CLI::App& command, RunningArguments& arguments);

/// Number of threads of this MPI rank.
int threads_of(const RunningArguments& arguments);
/// Measures the time of an evaluation, for the estimate before a run and the remaining time in progress reports.
RunCost measured_cost(const Study& study, const Session& session);

/// Converts the arguments; prints a warning if there are more threads than cores.
RunOptions run_options(const RunningArguments& arguments, const Session& session);
/// Shows progress on stderr, as a bar or as lines; nothing when quiet.
std::unique_ptr<Progress> make_progress(const RunningArguments& arguments);

/// Outcome of a run, even if its study file could not be written at the end.
struct RunEnd {
  RunOutcome outcome;
  std::optional<std::string> write_error = {};  ///< message, if the file could not be written
};
/// Calls `run`, and catches UnwrittenOutcome.
RunEnd execute_run(const std::function<RunOutcome()>& run);

/// If the study found no feasible design, sets the exit code, and when quiet prints the diagnosis in one line on
/// stderr.
/// @param diagnosis  std::nullopt: the study found a feasible design
void report_diagnosis(const std::optional<Diagnosis>& diagnosis, const RunningArguments& arguments, Session& session);

/// Prints the results of a run and sets the exit code. After that, throws StorageError if the results could not be
/// written to the file, and std::runtime_error if an exact volume contradicts its certified bounds.
void print_run_end(const RunEnd& end, const Study& study, const std::string& file, const RunningArguments& arguments,
                   Session& session);

}  // namespace pkm
