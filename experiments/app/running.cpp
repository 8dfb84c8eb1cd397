#include "experiments/app/running.hpp"

#include <unistd.h>

#include <iostream>

#include "engine/core/ranks.hpp"
#include "engine/core/team.hpp"
#include "engine/core/thread_limit.hpp"
#include "engine/core/unit.hpp"
#include "engine/results/comparison.hpp"
#include "engine/runner/python_functions.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/live_page.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/report.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/version.hpp"

namespace pkm {

SlowStepNotice announce_slow_step(const Session& session, const std::string& step) {
  const double after = isatty(STDERR_FILENO) == 1 ? 1 : 10;  // time [s] after which the step is announced
  return SlowStepNotice([&session, step] { std::cerr << session.program << ": " << step << std::endl; }, after);
}

void add_threads(CLI::App& command, int& threads) {
  add_integer(command, "--threads N", threads, 1, kMaxThreads,
              "Number of threads (default: OMP_NUM_THREADS, else one per core)");
}

void add_workers(CLI::App& command, int& workers) {
  add_integer(command, "--workers N", workers, 1, kMaxThreads,
              "Number of processes that call the study's Python functions (default: one per thread)");
}

void start_python(const Study& study, const std::string& file, int workers, int threads) {
  start_python_workers(study, {folder_of(file), ""}, {}, {.workers = workers}, team_size(threads));
}

namespace {

double time_limit(const std::string& text) {
  const auto seconds = parse_quantity(text, "s");
  if (seconds && *seconds > 0) return *seconds;
  throw ConfigError({"", 0, "--time"}, "'" + text + "'", "a time > 0 s, such as 90, \"10 min\" or \"2 h\"");
}

}  // namespace

void add_running_options(CLI::App& command, RunningArguments& arguments) {
  add_threads(command, arguments.threads);
  add_workers(command, arguments.workers);
  add_option(command, "--time T", arguments.time, "Stop with a checkpoint after this time, such as 90 or \"10 min\"");
  command.add_flag("-q,--quiet", arguments.quiet, "Print errors and warnings only");
  command.add_flag("--json", arguments.json, "Print the results as one JSON object, numbers in full precision");
  command.add_flag("--live", arguments.live,
                   "Write a page that shows the running study, F.live.html, and at the end the report, F.html");
}

int threads_of(const RunningArguments& arguments) {
  return team_size(arguments.threads > 0 ? arguments.threads : ranks::threads());
}

RunOptions run_options(const RunningArguments& arguments, const Session& session) {
  if (const auto warning = ranks::oversubscription_warning(threads_of(arguments)))
    std::cerr << session.program << ": warning: " << *warning << '\n';
  RunOptions options{.threads = arguments.threads,
                     .python = {.workers = arguments.workers},
                     .program = {program_version(), program_revision(), session.arguments}};
  if (!arguments.time.empty()) options.time_limit = time_limit(arguments.time);
  return options;
}

std::vector<std::string> live_files(const std::string& file, const RunningArguments& arguments) {
  if (!arguments.live) return {};
  return {live_page_file(file), report_file_beside(file)};
}

namespace {

/// The study at its last checkpoint; std::nullopt if there is no readable study file.
std::optional<StudyContents> last_checkpoint(const std::string& file) {
  try {
    return read_study(file);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

RunOutcome run_with_live_page(const StudyContents& contents, const std::string& file, const RunningArguments& arguments,
                              RunOptions options, const Session& session,
                              const std::function<RunOutcome(const RunOptions&)>& run) {
  if (!arguments.live || ranks::rank() != 0) return run(options);
  LivePage page(live_page_file(file), file, contents);
  if (!arguments.quiet) std::cerr << "live page: " << live_page_file(file) << '\n';
  options.observer = [&page](const StudyContents& so_far, const ProgressReport& report) {
    page.update(so_far, report);
  };
  RunOutcome outcome;
  try {
    outcome = run(options);
  } catch (const UnwrittenOutcome& failure) {
    page.fail(failure.outcome.contents, failure.what());
    throw;
  } catch (const std::exception& error) {
    page.fail(last_checkpoint(file).value_or(contents), error.what());
    throw;
  }
  std::string report;
  if (outcome.stopped.empty()) try {
      report = write_report_beside(file, threads_of(arguments), session);
    } catch (const std::exception& error) {  // the results are in the study file, from which the report can be written
      std::cerr << session.program << ": warning: no report was written: " << error.what() << '\n';
    }
  page.finish(outcome.contents, outcome.stopped, report);
  return outcome;
}

std::unique_ptr<Progress> make_progress(const RunningArguments& arguments) {
  if (arguments.quiet) return std::make_unique<Progress>();
  return std::make_unique<ScreenProgress>(stderr);
}

RunEnd execute_run(const std::function<RunOutcome()>& run) {
  try {
    return {run()};
  } catch (const UnwrittenOutcome& failure) {
    return {failure.outcome, failure.what()};
  }
}

void report_diagnosis(const std::optional<Diagnosis>& diagnosis, const RunningArguments& arguments, Session& session) {
  if (!diagnosis) return;
  session.exit_code = kNothingFeasible;
  if (arguments.quiet) std::cerr << session.program << ": " << one_line_summary(*diagnosis) << '\n';
}

namespace {

/// Throws StorageError if the results could not be written, and std::runtime_error if an exact volume contradicts its
/// certified bounds.
void throw_failures(const RunEnd& end) {
  std::cout << std::flush;
  if (end.write_error) throw StorageError(*end.write_error);
  if (const auto errors = contradicted(end.outcome.contents); !errors.empty())
    throw std::runtime_error(join(errors, "; "));
}

}  // namespace

std::string stop_words(const std::string& cause) {
  return cause + (cause == "SIGINT" ? " (Ctrl-C)" : "") + ", exit code " + std::to_string(kStoppedEarly);
}

void print_run_end(const RunEnd& end, const Study& study, const std::string& file, const RunningArguments& arguments,
                   Session& session) {
  const RunOutcome& outcome = end.outcome;
  const auto diagnosis = diagnose(outcome.contents, study.problem.get());
  if (arguments.json) {
    Json json = summary_json(outcome.contents, diagnosis, collect_failures(outcome.contents, study.problem.get()));
    json["file"] = file;
    json["stopped_by"] = text_or_null(outcome.stopped);
    print_json(json);
    session.exit_code = !outcome.stopped.empty() ? kStoppedEarly : diagnosis ? kNothingFeasible : session.exit_code;
    throw_failures(end);
    return;
  }
  if (!arguments.quiet || end.write_error) std::cout << summary_text(outcome.contents, study, diagnosis);
  if (!outcome.stopped.empty()) {
    // The following lines are printed even with --quiet, because the results are not final.
    std::cout << "stopped by " << stop_words(outcome.stopped) << ", after " << outcome.contents.evaluations()
              << " evaluations";
    if (!end.write_error) std::cout << "; resume with: " << command_text(session, {"resume", file_argument(file)});
    std::cout << '\n';
    session.exit_code = kStoppedEarly;
  } else if (!arguments.quiet) {
    const std::string exchange =
        ranks::size() > 1 ? formatted("messages between ranks %.1f %% and ", 100 * outcome.exchange_share) : "";
    // Time [s] of a run below which its shares are not representative and are not printed. With several MPI ranks, the
    // line also confirms that all of them took part.
    constexpr double kShort = 1;
    if (outcome.evaluations == 0)
      std::cout << "the study was already finished: no new evaluations\n";
    else if (outcome.seconds >= kShort || ranks::size() > 1)
      std::cout << "this run: " << outcome.evaluations << " evaluations in " << duration_text(outcome.seconds)
                << formatted(", parallel efficiency %.0f %% on ", 100 * outcome.parallel_efficiency) << outcome.team
                << ", " << exchange << formatted("checkpoints %.1f %% of the time\n", 100 * outcome.checkpoint_share);
    if (!end.write_error)
      std::cout << "written to " << file << '\n' << next_step(session, {"report", file_argument(file)});
  }
  if (outcome.stopped.empty() && !end.write_error) report_diagnosis(diagnosis, arguments, session);
  throw_failures(end);
}

}  // namespace pkm
