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
  bool quiet = false, json = false, live = false;
};

/// Declares --threads.
void add_threads(CLI::App& command, int& threads);
/// Declares --workers.
void add_workers(CLI::App& command, int& workers);
/// Starts the worker processes for the Python functions of a study, if it calls any.
/// @param file  the TOML file or study file, in whose folder the Python functions are
void start_python(const Study& study, const std::string& file, int workers, int threads);
/// Declares --threads, --workers, --time, --quiet, --json and --live.
void add_running_options(CLI::App& command, RunningArguments& arguments);

/// Number of threads that this MPI rank uses.
int threads_of(const RunningArguments& arguments);
/// Measures the time of an evaluation, for the estimate before a run and the remaining time in progress reports.
RunCost measured_cost(const Study& study, const Session& session);

/// Converts the arguments of the command to run options. Prints a warning if there are more threads than cores.
RunOptions run_options(const RunningArguments& arguments, const Session& session);
/// Executes a run with a live page (experiments/app/live_page.hpp) if --live is given: calls `run` with `options` whose
/// observer updates the page; afterwards writes the report beside the study file and the final state of the page. If
/// `run` throws, the page keeps its last state.
/// @param contents  the study before this run; `run` may move it
/// @param file      the study file
RunOutcome run_with_live_page(const StudyContents& contents, const std::string& file, const RunningArguments& arguments,
                              RunOptions options, const Session& session,
                              const std::function<RunOutcome(const RunOptions&)>& run);
/// The files that --live writes for a study file: the page and the report. None without --live.
std::vector<std::string> live_files(const std::string& file, const RunningArguments& arguments);
/// The progress display on stderr: a bar on a terminal, lines elsewhere, nothing with --quiet.
std::unique_ptr<Progress> make_progress(const RunningArguments& arguments);

/// Outcome of a run; also available if the study file could not be written at the end.
struct RunEnd {
  RunOutcome outcome;
  /// The error message if the file could not be written; otherwise std::nullopt.
  std::optional<std::string> write_error = {};
};
/// Calls `run`, and converts the exception UnwrittenOutcome into an outcome with an error message.
RunEnd execute_run(const std::function<RunOutcome()>& run);

/// Sets the exit code if the study found no feasible design and, with --quiet, prints the diagnosis in one line on
/// stderr.
/// @param diagnosis  std::nullopt: the study found a feasible design
void report_diagnosis(const std::optional<Diagnosis>& diagnosis, const RunningArguments& arguments, Session& session);

/// Prints the results of a run, with --json as one JSON object, and sets the exit code. After that, throws StorageError
/// if the results could not be written to the file, and std::runtime_error if an exact volume contradicts its certified
/// bounds.
void print_run_end(const RunEnd& end, const Study& study, const std::string& file, const RunningArguments& arguments,
                   Session& session);

}  // namespace pkm
