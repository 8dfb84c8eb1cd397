#include "experiments/app/running.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

#include "experiments/app/commands.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/version.hpp"

namespace pkm {

void add_running_options(CLI::App& command, RunningArguments& arguments) {
  command.add_option("--threads", arguments.threads, "Number of threads (default: one per core)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--quiet", arguments.quiet, "Print nothing but errors and warnings");
}

RunOptions run_options(const RunningArguments& arguments) {
  RunOptions options;
  options.threads = arguments.threads;
  options.program = {program_version(), program_revision()};
  return options;
}

int threads_of(const RunningArguments& arguments) { return ParallelEvaluator(arguments.threads).threads(); }

std::unique_ptr<Progress> make_progress(const RunningArguments& arguments) {
  if (arguments.quiet) return std::make_unique<Progress>();
  return std::make_unique<ScreenProgress>(stderr);
}

void print_stop(const RunOutcome& outcome, const std::string& file) {
  std::cout << "stopped by " << outcome.stopped << " after " << outcome.contents.evaluations()
            << " evaluations; go on with: pkmopt resume " << file << '\n';
}

int print_outcome(const RunOutcome& outcome, const Study& study, const std::string& file,
                  const RunningArguments& arguments) {
  if (!outcome.stopped.empty()) {
    print_stop(outcome, file);  // also when quiet: the one thing that must not be missed
    return kStoppedEarly;
  }
  if (arguments.quiet) return kDone;
  std::cout << summary_text(outcome.contents, study);
  char line[160];
  std::snprintf(line, sizeof line, "this run: %lld evaluations in %s, parallel efficiency %.0f %% on %d threads\n",
                static_cast<long long>(outcome.evaluations), duration_text(outcome.seconds).c_str(),
                100 * outcome.parallel_efficiency, threads_of(arguments));
  if (outcome.evaluations > 0) std::cout << line;
  std::cout << "written to " << file << '\n';
  return kDone;
}

}  // namespace pkm
