#include "experiments/app/run.hpp"

#include <filesystem>
#include <iostream>
#include <limits>

#include "engine/core/stop.hpp"
#include "engine/report/standing.hpp"
#include "engine/study/records.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

/// A given voxel box that cuts the workspace makes it look smaller than it is.
void warn_of_box(const Study& study, const Session& session) {
  const auto& parts = study.problem->parts();
  if (!parts.plan.voxels() || !parts.plan.box()) return;
  const std::string name = study.baseline ? "baseline" : "nominal design";
  const std::string& program = session.program;
  const SlowStep slow = announced(session, "evaluating the " + name);
  const StopScope limit(RunCost::kLongest);
  try {
    const auto report = study.problem->report(study.baseline ? *study.baseline : parts.parameters);
    if (report.survey.touches_box)
      std::cerr << program << ": warning: feasible cells of the " << name
                << " touch the box of [workspace]; the workspace may be larger than what is counted\n";
  } catch (const Stopped&) {
    std::cerr << program << ": warning: whether the workspace of the " << name
              << " touches the box of [workspace] is unknown: its evaluation takes more than "
              << duration_text(RunCost::kLongest) << '\n';
  }
}

/// What the command line changed in a study.
std::string changes_of(const Study& study) { return study.changes.empty() ? "no changes" : join(study.changes, " "); }

/// Why a file's study is not the one that is to be run.
Refusal refuse_other(const StudyContents& contents, const Study& study, const Catalogues& catalogues) {
  if (contents.toml != study.text && without_changes(contents.toml) == without_changes(study.text))
    return "the study with " + changes_of(study_of(contents, catalogues)) + ", not with " + changes_of(study);
  if (contents.toml != study.text) return "another text of the study than " + study.file_name;
  if (study.description && contents.description && contents.description->text != study.description->text)
    return "another text of the mechanism than " + study.description->file_name;
  if (contents.seed != study.seed)
    return "the study with seed " + std::to_string(contents.seed) + ", not " + std::to_string(study.seed);
  return {};
}

void run(const RunArguments& arguments, Session& session) {
  expect_toml(arguments.study, "resume", session);
  expect_file(arguments.study, "a study in TOML", "new study", session);
  Study study = load_study_toml(arguments.study, session.catalogues, arguments.changes);
  if (arguments.seed) study.seed = static_cast<std::uint64_t>(*arguments.seed);
  const std::string output = arguments.output.empty() ? study.output_file() : arguments.output;
  check_outputs({output}, inputs_of(study), Existing::replaced);
  for (const auto& warning : study.warnings) std::cerr << session.program << ": warning: " << warning << '\n';
  for (const Reason& reason : contradictions(study.problem->parts()))
    std::cerr << session.program << ": warning: " << reason.sentence << '\n';
  warn_of_box(study, session);
  RunOptions options = run_options(arguments.common, session);
  if (!arguments.common.quiet) {
    options.cost = measured_cost(study, session);
    print_estimate(study, options.cost, arguments.seeds, threads_of(arguments.common));
  }
  if (arguments.seeds > 1) {
    run_seeds(study, output, arguments, options, session);
    return;
  }
  const auto progress = make_progress(arguments.common);
  const RunEnd end = end_of_run([&] { return run_one(study, output, arguments, options, session, *progress); });
  progress->finish();
  print_end(end, study, output, arguments.common, session);
}

}  // namespace

std::vector<std::string> inputs_of(const Study& study) {
  if (!study.description) return {study.file_name};
  return {study.file_name, study.description->file_name};
}

bool exists(const std::string& file) {
  std::error_code unseen;  // the attempt to open it tells
  return std::filesystem::exists(file, unseen);
}

RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments,
                   const RunOptions& options, Session& session, Progress& progress) {
  if (!arguments.resume || !exists(output)) return run_study(study, output, arguments.force, options, progress);
  HeldStudy held(output);
  if (const Refusal reason = refuse_other(held.contents, study, session.catalogues))
    throw StorageError(output + " holds " + *reason + "; go on with it by '" + session.program + " resume " +
                       quoted(file_argument(output)) + "', or overwrite it with --force");
  if (held.contents.state == StudyState::finished) {
    study_to_continue(held.contents, output, session.catalogues);
    return {.contents = std::move(held.contents)};
  }
  return resume_study(held, session.catalogues, {}, options, progress);
}

void add_run(CLI::App& app, Session& session) {
  const auto [command, arguments] =
      add_command<RunArguments>(app, "run", "Runs a study and writes its study file.",
                                "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml --threads 2",
                                [&session](const RunArguments& given) { run(given, session); });
  add_option(command, "study STUDY.toml", arguments.study, "The study, a TOML file")->required();
  add_option(command, "-o,--output F.h5", arguments.output,
             "The study file (default: as the study says, else its stem + .h5)");
  command.add_flag("--resume", arguments.resume, "Go on with the study file if it exists");
  command.add_flag("--force", arguments.force, "Overwrite the study file if it exists")->excludes("--resume");
  add_integer(command, "--seed N", arguments.seed, 0, std::numeric_limits<std::int64_t>::max(),
              "Seed, instead of the study's own");
  add_integer(command, "--seeds N", arguments.seeds, 1, 100'000,
              "Repeat the study over N seeds, a file each, and print the spread");
  add_change_options(command, arguments.changes);
  add_running_options(command, arguments.common);
}

}  // namespace pkm
