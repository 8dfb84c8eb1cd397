// End of a run: computes the final results and writes the study file. If memory is exhausted, saves the complete
// generations.
#include <cmath>
#include <new>
#include <utility>

#include "engine/core/catalogue.hpp"
#include "engine/core/stop.hpp"
#include "engine/runner/final_record.hpp"
#include "engine/runner/machine.hpp"
#include "engine/runner/run.hpp"

namespace pkm {
namespace {

/// Sentence about the parallel efficiency of a run with several MPI ranks.
std::string ranks_note(const RunOutcome& outcome) {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  return std::to_string(outcome.evaluations) + " evaluations by " + outcome.team + " on " + describe_hosts() +
         ": parallel efficiency " + percent(outcome.parallel_efficiency) + ", " + percent(outcome.exchange_share) +
         " of the time in messages between ranks";
}

}  // namespace

RunOutcome Run::complete() {
  RunOutcome outcome = statistics();
  std::optional<std::string> write_error;
  if (!stopped_.empty() && replaying_ && evaluator_.made() == 0) {
    // The run was stopped during replay, so the file contains more evaluations than this run.
    contents_ = read_study(output_->path());
  } else {
    if (ranks::size() > 1 && outcome.evaluations > 0) contents_.notes.push_back(ranks_note(outcome));
    for (const auto& [call, reason] : study_.problem->parts().functions->failures())
      if (const std::string note = "first failure of " + call + ": " + reason; !contains(contents_.notes, note))
        contents_.notes.push_back(note);
    if (stopped_.empty()) compute_final_results();
    try {
      write(stopped_.empty() ? StudyState::finished : StudyState::interrupted);
    } catch (const StorageError& failure) {
      write_error = failure.what();
    }
  }
  outcome.stopped = stopped_;
  outcome.contents = std::move(contents_);
  outcome.seconds = seconds();
  outcome.checkpoint_share = clock_.share();
  if (write_error) throw UnwrittenOutcome(*write_error, std::move(outcome));
  return outcome;
}

// Writes the study file before the optional final steps (such as certified bounds), because these may take long.
void Run::compute_final_results() {
  const StopScope stop([this] { return is_grace_period_over(); });
  std::optional<SlowStepNotice> slow;
  const auto begin = [&](const std::string& what) {
    slow.reset();
    slow.emplace([this, what] { progress_.step(what); });
  };
  try {
    begin("values of the final designs");
    contents_.final = final_record(study_, contents_);
    try {
      write(StudyState::running);
    } catch (const StorageError&) {  // ignored, because the file is written again at the end of the run
    }
    complete_final_record(study_, contents_, begin);
  } catch (const Stopped&) {  // a resumed run continues with the steps that are missing
    goes_on();
  }
}

RunOutcome Run::statistics() const {
  RunOutcome outcome;
  outcome.evaluations = evaluator_.made();
  if (ranks::size() > 1) {  // with several ranks, multistart runs have been evaluated on other ranks as well
    outcome.evaluations = contents_.evaluations();
    for (const StageRecord& stage : recorded_) outcome.evaluations -= static_cast<std::int64_t>(stage.table.size());
    outcome.exchange_share = (ranks::communication_seconds() - initial_exchange_) / seconds();
  }
  outcome.warnings = warnings_;
  outcome.parallel_efficiency = evaluator_.efficiency(threads_);
  outcome.team = describe_team(evaluator_.threads(), threads_);
  return outcome;
}

void Run::write(StudyState state) {
  if (!output_) return;
  if (ahead_) contents_.stages.back().ahead = ahead_();
  contents_.state = state;
  contents_.seconds = earlier_seconds_ + seconds();
  contents_.updated = utc_now();
  output_->write(contents_);
}

void Run::save_after_out_of_memory() {
  evaluator_.release_memory();
  recorded_ = {};
  ahead_ = {};
  std::string saved = "its previous contents";
  if (!replaying_ && complete_rows_) try {
      if (!contents_.stages.empty()) {
        StageRecord& stage = contents_.stages.back();
        if (!stage.finished) stage.table.truncate(*complete_rows_);
        stage.ahead.clear();
        if (stage.table.size() == 0) contents_.stages.pop_back();
      }
      contents_.final.reset();
      write(StudyState::interrupted);
      saved = "the " + std::to_string(contents_.evaluations()) + " complete evaluations";
    } catch (const std::bad_alloc&) {  // the last checkpoint remains valid
    }
  throw StorageError(output_->path() + ": out of memory in stage " + std::to_string(stage_ + 1) + "; the file has " +
                     saved + " and can be resumed with fewer threads or more memory");
}

}  // namespace pkm
