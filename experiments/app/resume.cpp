// pkmopt resume: goes on with a study file, or extends a finished study.

#include <iostream>

#include "engine/core/unit.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/summary.hpp"

namespace pkm {
namespace {

struct ResumeArguments {
  std::string file;
  ExtensionRequest extension;
  std::string time;
  RunningArguments common;
};

double time_limit(const std::string& text) {
  const auto seconds = parse_quantity(text, "s");
  if (seconds && *seconds > 0) return *seconds;
  throw ConfigError({"", 0, "--time"}, "'" + text + "'", "a time > 0 s, such as 90, \"10 min\" or \"2 h\"");
}

void resume(const ResumeArguments& arguments, Session& session) {
  RunOptions options = run_options(arguments.common);
  if (!arguments.time.empty()) options.time_limit = time_limit(arguments.time);
  const auto& extension = arguments.extension;
  HeldStudy held(arguments.file);
  if (!extension.generations && !extension.evaluations && held.contents.state == StudyState::finished) {
    if (!arguments.common.quiet)
      std::cout << summary_text(held.contents, study_of(held.contents, session.catalogues))
                << "nothing is left to do; --generations or --evaluations extend the last stage\n";
    return;
  }
  const auto progress = make_progress(arguments.common);
  const RunOutcome outcome = resume_study(held, session.catalogues, extension, options, *progress);
  progress->finish();
  print_outcome(outcome, study_of(outcome.contents, session.catalogues), arguments.file, arguments.common, session);
}

}  // namespace

void add_resume(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ResumeArguments>(
      app, "resume", "Goes on with a stopped study, or extends a finished one.",
      "What may change on resume: --threads, --quiet, and more --generations, --evaluations or --time.\n"
      "Example: pkmopt resume paper-problem.h5 --generations 200",
      [&session](const ResumeArguments& given) { resume(given, session); });
  add_option(command, "file F.h5", arguments.file, "The study file")->required();
  constexpr std::int64_t kMost = 1'000'000'000'000;
  const std::string meaning = "New limit of the last stage, in all";
  add_integer(command, "--generations N", arguments.extension.generations, 1, kMost, meaning);
  add_integer(command, "--evaluations N", arguments.extension.evaluations, 1, kMost, meaning);
  add_option(command, "--time T", arguments.time, "Stop with a checkpoint after this time: 90, \"10 min\"");
  add_running_options(command, arguments.common);
}

}  // namespace pkm
