// `pkmopt resume`: continues a stopped study from its file, or extends a finished study.

#include <iostream>

#include "engine/core/stop.hpp"
#include "engine/results/comparison.hpp"
#include "engine/runner/records.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/summary.hpp"

namespace pkm {
namespace {

struct ResumeArguments {
  std::string file;
  ExtensionRequest extension;
  RunningArguments common;
};

void resume(const ResumeArguments& arguments, Session& session) {
  expect_study_file(arguments.file, "run", session);
  RunOptions options = run_options(arguments.common, session);
  const auto& extension = arguments.extension;
  LockedStudy locked(arguments.file);
  if (!extension.generations && !extension.evaluations && locked.contents.state == StudyState::finished) {
    const Study study = study_to_continue(locked.contents, arguments.file, session.catalogues);
    const auto diagnosis = diagnose(locked.contents, study.problem.get());
    if (arguments.common.json)
      print_json(summary_json(locked.contents, diagnosis, collect_failures(locked.contents, study.problem.get())));
    else if (!arguments.common.quiet)
      std::cout << summary_text(locked.contents, study, diagnosis)
                << "the study is finished; --generations or --evaluations extend its last stage\n";
    report_diagnosis(diagnosis, arguments.common, session);
    return;
  }
  if (!arguments.common.quiet || locked.contents.functions) {
    const StopScope stop([] { return StopRequest::signal() != 0; });
    const Study study = study_to_continue(locked.contents, arguments.file, session.catalogues);
    connect_functions(study, locked.contents, arguments.file, options);
    options.functions = study.problem->parts().functions->caller;
    if (!arguments.common.quiet) options.cost = measured_cost(study, session);
  }
  const auto progress = make_progress(arguments.common);
  const RunEnd end = execute_run([&] {
    return run_with_live_page(locked.contents, arguments.file, arguments.common, options, session,
                              [&](const RunOptions& observed) {
                                return resume_study(locked, session.catalogues, extension, observed, *progress);
                              });
  });
  progress->finish();
  const Study study = study_of(end.outcome.contents, session.catalogues);
  study.problem->parts().functions->caller = options.functions;
  print_run_end(end, study, arguments.file, arguments.common, session);
}

}  // namespace

void add_resume(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ResumeArguments>(
      app, "resume", "Resume a stopped study, or extend a finished one.",
      "These options may change on resume: --threads, --quiet, --time, and larger --generations or --evaluations.\n"
      "Example: pkmopt resume paper-problem.h5 --generations 200",
      [&session](const ResumeArguments& given) { resume(given, session); });
  add_option(command, "file F.h5", arguments.file, "The study file")->required();
  constexpr std::int64_t kMax = 1'000'000'000'000;
  const std::string meaning = "New limit of the last stage, counted from its beginning";
  add_integer(command, "--generations N", arguments.extension.generations, 1, kMax, meaning);
  add_integer(command, "--evaluations N", arguments.extension.evaluations, 1, kMax, meaning);
  add_running_options(command, arguments.common);
}

}  // namespace pkm
