// pkmopt resume: goes on with a study file, or extends a finished study.

#include <iostream>

#include <CLI/CLI.hpp>

#include "engine/core/unit.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/commands.hpp"
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
  try {
    const double seconds = parse_quantity(text, "s");
    if (seconds > 0) return seconds;
  } catch (const std::invalid_argument&) {
  }
  throw ConfigError({"", 0, "--time"}, "'" + text + "'", "a time > 0 s, such as 90, \"10 min\" or \"2 h\"");
}

}  // namespace

void add_resume(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ResumeArguments>();
  CLI::App* command = app.add_subcommand("resume", "Goes on with a stopped study, or extends a finished one.");
  command->add_option("file", arguments->file, "The study file")->required()->type_name("F.h5");
  const auto limit = CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000'000});
  command->add_option("--generations", arguments->extension.generations, "New limit of the last stage, in all")
      ->type_name("N")
      ->check(limit);
  command->add_option("--evaluations", arguments->extension.evaluations, "New limit of the last stage, in all")
      ->type_name("N")
      ->check(limit);
  command->add_option("--time", arguments->time, "Stop with a checkpoint after this time: 90, \"10 min\"")
      ->type_name("T");
  add_running_options(*command, arguments->common);
  command->footer(
      "What may change on resume: --threads, --quiet, and more --generations, --evaluations or --time.\n"
      "Example: pkmopt resume paper-problem.h5 --generations 200");
  command->callback([arguments, &session] {
    RunOptions options = run_options(arguments->common);
    if (!arguments->time.empty()) options.time_limit = time_limit(arguments->time);
    const auto& extension = arguments->extension;
    if (!extension.generations && !extension.evaluations) {
      const StudyContents contents = read_study(arguments->file);
      if (contents.state == StudyState::finished) {
        if (!arguments->common.quiet)
          std::cout << summary_text(contents, study_of(contents, session.catalogues))
                    << "nothing is left to do; --generations or --evaluations extend the last stage\n";
        return;
      }
    }
    const auto progress = make_progress(arguments->common);
    const RunOutcome outcome = resume_study(arguments->file, session.catalogues, extension, options, *progress);
    progress->finish();
    session.exit_code = print_outcome(outcome, study_of(outcome.contents, session.catalogues), arguments->file,
                                      arguments->common, session.program);
  });
}

}  // namespace pkm
