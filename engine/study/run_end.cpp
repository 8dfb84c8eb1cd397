// How a run ends: what it has come to, worked out and written, also where memory has run out.
#include <cmath>
#include <new>
#include <utility>

#include "engine/core/stop.hpp"
#include "engine/study/final_record.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/run.hpp"

namespace pkm {
namespace {

std::string note_of_ranks(const RunOutcome& outcome) {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  return std::to_string(outcome.evaluations) + " evaluations by " + outcome.team + " on " + describe_hosts() +
         ": parallel efficiency " + percent(outcome.parallel_efficiency) + ", " + percent(outcome.exchange_share) +
         " of the time in messages between ranks";
}

}  // namespace

RunOutcome Run::outcome() {
  RunOutcome outcome = measures();
  std::optional<std::string> unwritten;
  if (!stopped_.empty() && replaying_ && evaluator_.made() == 0) {
    contents_ =
        read_study(output_->path());  // stopped before it came to anything new: the file holds more than this run
  } else {
    if (ranks::size() > 1 && outcome.evaluations > 0) contents_.notes.push_back(note_of_ranks(outcome));
    if (stopped_.empty()) finish();
    try {
      write(stopped_.empty() ? StudyState::finished : StudyState::interrupted);
    } catch (const StorageError& failure) {
      unwritten = failure.what();
    }
  }
  outcome.stopped = stopped_;
  outcome.contents = std::move(contents_);
  outcome.seconds = seconds();
  outcome.checkpoint_share = clock_.share();
  if (unwritten) throw UnwrittenOutcome(*unwritten, std::move(outcome));
  return outcome;
}

/// What was found is stored before what may take long.
void Run::finish() {
  const StopScope stop([this] { return is_overdue(); });
  try {
    contents_.final = final_record(study_, contents_);
    try {
      write(StudyState::running);
    } catch (const StorageError&) {  // the last write tells, or succeeds
    }
    std::optional<SlowStep> slow;
    complete_final_record(study_, contents_, [&](const std::string& what) {
      slow.reset();
      slow.emplace([this, what] { progress_.step(what); });
    });
  } catch (const Stopped&) {  // goes on here when it is resumed
    goes_on();
  }
}

RunOutcome Run::measures() const {
  RunOutcome outcome;
  outcome.evaluations = evaluator_.made();
  if (ranks::size() > 1) {  // starts of solvers were made elsewhere, too
    outcome.evaluations = contents_.evaluations();
    for (const StageRecord& stage : recorded_) outcome.evaluations -= static_cast<std::int64_t>(stage.table.size());
    outcome.exchange_share = (ranks::seconds_in_exchange() - exchanged_) / seconds();
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

void Run::keep_what_is_whole() {
  evaluator_.forget();
  recorded_ = {};
  ahead_ = {};
  std::string kept = "what it held before";
  if (!replaying_ && whole_rows_) try {
      if (!contents_.stages.empty()) {
        StageRecord& stage = contents_.stages.back();
        if (!stage.finished) stage.table.truncate(*whole_rows_);
        stage.ahead.clear();
        if (stage.table.size() == 0) contents_.stages.pop_back();
      }
      contents_.final.reset();
      write(StudyState::interrupted);
      kept = "what is complete, " + std::to_string(contents_.evaluations()) + " evaluations,";
    } catch (const std::bad_alloc&) {  // then the last checkpoint stands
    }
  throw StorageError(output_->path() + ": out of memory in stage " + std::to_string(stage_ + 1) + "; the file keeps " +
                     kept + " and can be resumed, with fewer threads or more memory");
}

}  // namespace pkm
