#include "experiments/app/run.hpp"

#include <filesystem>
#include <iostream>
#include <limits>

#include "engine/config/upgrade.hpp"
#include "engine/core/stop.hpp"
#include "engine/results/comparison.hpp"
#include "engine/runner/records.hpp"
#include "engine/runner/start_from.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

/// Warns if the voxel box of the study cuts off the workspace of the baseline (or of the nominal design), so that the
/// computed volume is too small.
void warn_if_box_cuts(const Study& study, const Session& session) {
  const auto& parts = study.problem->parts();
  if (!parts.plan.voxels() || !parts.plan.box()) return;
  const std::string name = study.baseline ? "baseline" : "nominal design";
  const std::string& program = session.program;
  const SlowStepNotice slow = announce_slow_step(session, "evaluating the " + name);
  const StopScope limit(RunCost::kTimeLimit);
  try {
    const auto report = study.problem->report(study.baseline ? *study.baseline : parts.parameters);
    if (report.workspace.touches_box)
      std::cerr << program << ": warning: feasible cells of the " << name
                << " touch the box of [workspace]; the workspace may extend beyond it\n";
  } catch (const Stopped&) {
    std::cerr << program << ": warning: whether the workspace of the " << name
              << " touches the box of [workspace] is unknown: its evaluation takes more than "
              << duration_text(RunCost::kTimeLimit) << '\n';
  }
}

/// The changes that the command line makes to a study, written as options; "no changes" if there are none.
std::string changes_of(const Study& study) { return study.changes.empty() ? "no changes" : join(study.changes, " "); }

/// The reason why a study file does not belong to the study to be run; empty if it does.
Unsupported refuse_different_study(const StudyContents& contents, const Study& study, const Catalogues& catalogues) {
  const std::string text = upgraded(contents.toml, TextKind::study).text;
  if (text != study.text && without_changes(text) == without_changes(study.text)) {
    const Study other = study_of(contents, catalogues);
    if (other.changes == study.changes) return "a study whose catalogues differ from those of " + study.file_name;
    return "the study with " + changes_of(other) + ", not with " + changes_of(study);
  }
  if (text != study.text) return "a study whose text differs from " + study.file_name;
  if (study.description && contents.description &&
      upgraded(contents.description->text, TextKind::mechanism).text != study.description->text)
    return "a study whose mechanism file differs from " + study.description->file_name;
  if (contents.seed != study.seed)
    return "the study with seed " + std::to_string(contents.seed) + ", not " + std::to_string(study.seed);
  return {};
}

/// Returns the study with its first stage changed to start from designs of the study file `file`.
Study with_starts(const Study& study, const std::string& file, const RunArguments& arguments, const Session& session) {
  expect_study_file(file, "run", session);
  const StudyContents other = read_study(file);
  const StartFrom found = start_from(study, other, file);
  const std::string& mechanism = study.problem->parts().mechanism->info().name;
  if (other.problem.mechanism != mechanism)
    std::cerr << session.program << ": warning: " << file << " is a study of " << other.problem.mechanism << ", "
              << study.file_name << " one of " << mechanism << '\n';
  const std::size_t count = found.start.size();
  std::cerr << study.name << ": starts from " << count << (count == 1 ? " design of " : " designs of ") << file;
  if (found.moved > 0) std::cerr << ", of which " << found.moved << " moved to the nearest design within the bounds";
  if (!found.missing.empty()) std::cerr << "; " << join(found.missing) << " not in it: as in the baseline";
  std::cerr << '\n';
  StudyChanges changes = arguments.changes;
  changes.start_from = {file};
  changes.start = found.start;
  return load_study_toml(arguments.study, session.catalogues, changes);
}

void run(const RunArguments& arguments, Session& session) {
  expect_toml(arguments.study, "resume", session);
  expect_file(arguments.study, "a study in TOML", "new study", session);
  Study study = load_study_toml(arguments.study, session.catalogues, arguments.changes);
  require_stages(study, session.catalogues);
  if (!arguments.start_from.empty()) study = with_starts(study, arguments.start_from, arguments, session);
  if (arguments.seed) study.seed = static_cast<std::uint64_t>(*arguments.seed);
  const std::string output = arguments.output.empty() ? study.output_file() : arguments.output;
  check_outputs({output}, input_files(study), Existing::replaced);
  for (const auto& warning : study.warnings) std::cerr << session.program << ": warning: " << warning << '\n';
  for (const Reason& reason : contradictions(study.problem->parts()))
    std::cerr << session.program << ": warning: " << reason.sentence << '\n';
  start_python(study, arguments.study, arguments.common.workers, threads_of(arguments.common));
  warn_if_box_cuts(study, session);
  RunOptions options = run_options(arguments.common, session);
  options.functions = study.problem->parts().functions->caller;
  if (!arguments.common.quiet) {
    options.cost = measured_cost(study, session);
    if (!arguments.common.json) print_estimate(study, options.cost, arguments.seeds, threads_of(arguments.common));
  }
  if (arguments.seeds > 1) {
    run_seeds(study, output, arguments, options, session);
    return;
  }
  const auto progress = make_progress(arguments.common);
  const RunEnd end = execute_run([&] { return run_one(study, output, arguments, options, session, *progress); });
  progress->finish();
  print_run_end(end, study, output, arguments.common, session);
}

}  // namespace

std::vector<std::string> input_files(const Study& study) {
  std::vector<std::string> files = {study.file_name};
  if (study.description) files.push_back(study.description->file_name);
  files.insert(files.end(), study.catalogues.begin(), study.catalogues.end());
  return files;
}

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments,
                   const RunOptions& options, Session& session, Progress& progress) {
  check_outputs(live_files(output, arguments.common), input_files(study),
                if_forced(arguments.force || arguments.resume));
  const auto with_page = [&](const StudyContents& contents, const auto& execute) {
    return run_with_live_page(contents, output, arguments.common, options, session, execute);
  };
  if (!arguments.resume || !exists(output)) {
    // If the file exists, run_study() throws StorageError.
    if (!arguments.force && exists(output)) return run_study(study, output, false, options, progress);
    StudyContents nothing;
    nothing.name = study.name;
    return with_page(nothing, [&](const RunOptions& observed) {
      return run_study(study, output, arguments.force, observed, progress);
    });
  }
  LockedStudy locked(output);
  if (const Unsupported reason = refuse_different_study(locked.contents, study, session.catalogues))
    throw StorageError(output + " holds " + *reason + "; continue it with '" + session.program + " resume " +
                       quoted(file_argument(output)) + "', or overwrite it with --force");
  if (locked.contents.state == StudyState::finished) {
    study_to_continue(locked.contents, output, session.catalogues);
    return {.contents = std::move(locked.contents)};
  }
  return with_page(locked.contents, [&](const RunOptions& observed) {
    return resume_study(locked, session.catalogues, {}, observed, progress);
  });
}

void add_run(CLI::App& app, Session& session) {
  const auto [command, arguments] =
      add_command<RunArguments>(app, "run", "Run a study and write its study file.",
                                "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml --threads 2",
                                [&session](const RunArguments& given) { run(given, session); });
  add_option(command, "study STUDY.toml", arguments.study, "The study, a TOML file")->required();
  add_option(command, "-o,--output F.h5", arguments.output,
             "Study file to write (default: output of [study], else the study's stem + .h5)");
  command.add_flag("--resume", arguments.resume, "Resume the study file if it exists");
  command.add_flag("--force", arguments.force, "Overwrite the study file if it exists")->excludes("--resume");
  add_option(command, "--start-from OLD.h5", arguments.start_from,
             "Start the first stage from the best designs of another study, whose objectives may differ");
  add_integer(command, "--seed N", arguments.seed, 0, std::numeric_limits<std::int64_t>::max(),
              "Seed to use instead of the study's");
  add_integer(command, "--seeds N", arguments.seeds, 1, 100'000,
              "Repeat the study with N seeds, one file each, and print the spread");
  add_change_options(command, arguments.changes);
  add_running_options(command, arguments.common);
}

}  // namespace pkm
