#include "engine/study/run_study.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/core/ranks.hpp"
#include "engine/problem/replay.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/records.hpp"
#include "engine/study/run.hpp"
#include "engine/study/take_part.hpp"

namespace pkm {
namespace {

/// Rank 0's part of a run; the others' is take_part(). A first write that fails invites nobody.
RunOutcome run_with_ranks(const Study& study, StudyContents contents, StudyOutput output, const RunOptions& options,
                          Progress& progress) {
  std::string others = invitation(contents, options);
  Run run(study, std::move(contents), &output, options, progress);
  run.begin();
  ranks::broadcast(others);
  return run();
}

/// Results of our own code have the same bits everywhere; those of the libraries that we call may not.
void note_processor(StudyContents& contents) {
  const std::string here = describe_processor();
  if (contents.machine.starts_with(here + ",")) return;
  const std::string note = "begun on " + contents.machine + ", went on on " + describe_machine() +
                           ": stages of ipopt and isres and motions given as formulas may differ in their last bits "
                           "from a run on one processor";
  if (std::ranges::find(contents.notes, note) == contents.notes.end()) contents.notes.push_back(note);
}

}  // namespace

RunOutcome run_study(const Study& study, const std::string& path, bool overwrite, const RunOptions& options,
                     Progress& progress) {
  const StopRequest listen;
  const StudyLock lock(path);
  std::error_code unseen;  // the attempt to write tells
  if (!overwrite && std::filesystem::exists(path, unseen))
    throw StorageError(path + " exists already; resume it with --resume, or overwrite it with --force");
  return run_with_ranks(study, new_contents(study), StudyOutput(path, lock, if_forced(overwrite)), options, progress);
}

RunOutcome resume_study(HeldStudy& held, const Catalogues& catalogues, const ExtensionRequest& extension,
                        const RunOptions& options, Progress& progress) {
  const std::string& path = held.path;
  StudyContents& contents = held.contents;
  if (contents.algorithms != kAlgorithms)
    throw StorageError(path + " was written by pkmopt " + contents.program_version + " (" + contents.program_revision +
                       "), whose algorithms have version " + std::to_string(contents.algorithms) +
                       "; this program has version " + std::to_string(kAlgorithms) + " and would not repeat it");
  Study study = study_to_continue(contents, path, catalogues);
  contents.problem = problem_of(study);  // a parameter that the mechanism has gained is added
  if (extension.generations || extension.evaluations) {
    request_extension(study, contents, extension);
    contents.state = StudyState::interrupted;
    contents.final.reset();
    write_study(path, contents);  // so that the extension survives a stop while the past is replayed
  }
  apply_extensions(study, contents.extensions);
  note_processor(contents);
  try {
    return run_with_ranks(study, std::move(contents), StudyOutput(path, held.lock, Existing::replaced), options,
                          progress);
  } catch (const ReplayMismatch& mismatch) {
    throw StorageError(path + " cannot be continued: " + mismatch.what());
  }
}

}  // namespace pkm
