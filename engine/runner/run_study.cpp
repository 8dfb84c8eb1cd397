#include "engine/runner/run_study.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/core/ranks.hpp"
#include "engine/core/team.hpp"
#include "engine/problem/replay.hpp"
#include "engine/runner/machine.hpp"
#include "engine/runner/python_functions.hpp"
#include "engine/runner/records.hpp"
#include "engine/runner/run.hpp"
#include "engine/runner/worker_ranks.hpp"

namespace pkm {
namespace {

/// Runs a study on MPI rank 0, together with the worker ranks (see worker_ranks.hpp). If the first write of the study
/// file fails, the worker ranks are not involved.
RunOutcome run_with_ranks(const Study& study, StudyContents contents, StudyOutput output, const RunOptions& options,
                          Progress& progress) {
  std::string message = run_message(contents, options);
  Run run(study, std::move(contents), &output, options, progress);
  run.begin();
  ranks::broadcast(message);
  return run();
}

/// Adds a note if the study was started on another processor. The code of pkmopt gives identical bits on all
/// processors, but external libraries (solvers, mathematical functions) may not.
void note_processor(StudyContents& contents) {
  if (contents.machine.starts_with(describe_processor() + ",")) return;
  const std::string note = "started on " + contents.machine + ", resumed on " + describe_machine() +
                           ": results of ipopt and isres stages and of motions given as formulas may differ in the "
                           "last bits from those of a run on one processor";
  if (std::ranges::find(contents.notes, note) == contents.notes.end()) contents.notes.push_back(note);
}

}  // namespace

void connect_functions(const Study& study, const StudyContents& contents, const std::string& path,
                       const RunOptions& options) {
  if (!contents.functions) return;
  try {
    study.problem->parts().functions->caller = options.functions;
    start_python_workers(study, {folder_of(contents.toml_file), folder_of(path), ""}, *contents.functions,
                         options.python, team_size(options.threads > 0 ? options.threads : ranks::threads()));
    expect_recorded_functions(study, *contents.functions);
  } catch (const StorageError& reason) {
    throw StorageError(path + ": cannot be continued: " + reason.what());
  }
}

RunOutcome run_study(const Study& study, const std::string& path, bool overwrite, const RunOptions& options,
                     Progress& progress) {
  const auto stop_request = options.handles_signals ? std::make_unique<StopRequest>() : nullptr;
  const StudyLock lock(path);
  std::error_code error;  // ignored: an inaccessible path is reported when the file is written
  if (!overwrite && std::filesystem::exists(path, error))
    throw StorageError(path + " exists already; resume it with --resume, or overwrite it with --force");
  return run_with_ranks(study, new_contents(study), StudyOutput(path, lock, if_forced(overwrite)), options, progress);
}

RunOutcome resume_study(LockedStudy& locked, const Catalogues& catalogues, const ExtensionRequest& extension,
                        const RunOptions& options, Progress& progress) {
  const std::string& path = locked.path;
  StudyContents& contents = locked.contents;
  if (contents.algorithms != kAlgorithms)
    throw StorageError(path + ": written by pkmopt " + contents.program_version + " (" + contents.program_revision +
                       ") with algorithm version " + std::to_string(contents.algorithms) +
                       "; this program has version " + std::to_string(kAlgorithms) + " and would not reproduce it");
  Study study = study_to_continue(contents, path, catalogues);
  connect_functions(study, contents, path, options);
  contents.problem = problem_record(study);  // adds the parameters that this program version has in addition
  if (extension.generations || extension.evaluations) {
    request_extension(study, contents, extension);
    contents.state = StudyState::interrupted;
    contents.final.reset();
    write_study(path, contents);  // so that the extension is recorded even if the run is stopped during replay
  }
  apply_extensions(study, contents.extensions);
  note_processor(contents);
  try {
    return run_with_ranks(study, std::move(contents), StudyOutput(path, locked.lock, Existing::replaced), options,
                          progress);
  } catch (const ReplayMismatch& mismatch) {
    throw StorageError(path + ": cannot be continued: " + mismatch.what());
  }
}

}  // namespace pkm
