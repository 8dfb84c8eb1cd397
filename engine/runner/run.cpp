#include "engine/runner/run.hpp"

#include <cstring>
#include <new>
#include <utility>

#include "engine/core/stop.hpp"
#include "engine/problem/ranking.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/row_exchange.hpp"
#include "engine/runner/generation_record.hpp"
#include "engine/runner/optimality_record.hpp"
#include "engine/runner/records.hpp"
#include "engine/runner/stage_starts.hpp"

namespace pkm {
namespace {

/// Seed of a stage. Different seeds give the stages independent streams of random numbers.
std::uint64_t stage_seed(std::uint64_t study, std::size_t stage) {
  return study + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(stage);
}

}  // namespace

Run::Run(const Study& study, StudyContents contents, StudyOutput* output, const RunOptions& options, Progress& progress)
    : study_(study),
      output_(output),
      options_(options),
      progress_(progress),
      clock_(study.checkpoint_every),
      evaluator_(options.threads > 0 ? options.threads : ranks::threads()),
      contents_(std::move(contents)),
      recorded_(std::exchange(contents_.stages, {})),
      earlier_seconds_(contents_.seconds),
      replaying_(!recorded_.empty()) {
  contents_.best = {};
  contents_.final.reset();
  contents_.program_version = options.program.version;
  contents_.program_revision = options.program.revision;
  contents_.algorithms = kAlgorithms;
}

void Run::begin() {
  clock_.first([&] {
    if (recorded_.empty()) write(StudyState::running);
  });
}

RunOutcome Run::operator()() {
  for (const std::string& each : ranks::all_gather(std::to_string(evaluator_.threads()))) threads_ += std::stoi(each);
  RunOutcome result;
  // With several MPI ranks, evaluations are not aborted, because the other ranks would wait for them.
  std::optional<StopScope> stop;
  if (ranks::size() == 1) stop.emplace([this] { return is_grace_period_over(); });
  try {
    with_team(evaluator_.threads(), [&] {
      run_stages();
      if (failure_) std::rethrow_exception(failure_);
      if (ranks::rank() == 0) result = complete();
    });
  } catch (const std::bad_alloc&) {
    if (ranks::size() == 1) save_after_out_of_memory();
    ranks::abort_all_ranks("out of memory");
  }
  return result;
}

void Run::run_stages() {
  try {
    for (std::size_t i = 0; i < study_.stages.size(); ++i)
      if (!run_stage(i)) break;
  } catch (const Stopped&) {  // those evaluations of the aborted generation that are complete remain in the table
    ahead_ = {};
    if (contents_.stages.back().table.size() == 0) contents_.stages.pop_back();
    goes_on();
  } catch (const ReplayMismatch&) {  // thrown on every rank, so that no rank waits for another
    throw;
  } catch (const std::exception& error) {  // without this, the other ranks would wait for this one
    if (ranks::size() > 1) ranks::abort_all_ranks(message_of(error));
    throw;
  }
}

bool Run::run_stage(std::size_t index) {
  stage_ = index;
  complete_rows_ = 0;
  const Stage& stage = study_.stages[index];
  const StageInput input = stage_input(index);
  contents_.stages.push_back({stage.entry->name, option_lines(stage.options),
                              EvaluationTable(study_.problem->shape(stage.optimiser->detail()))});
  StageRecord& record = contents_.stages.back();
  limit_ = stage.optimiser->evaluation_limit(*study_.problem);
  const StageResult result = stage.optimiser->minimise(input, record.table);
  record.starts = result.starts;
  record.ahead = result.ahead;
  ahead_ = {};
  if (failed_) return false;
  if (result.reason == StopReason::interrupted) {
    goes_on();  // sets the reason for stopping if an evaluation was aborted
    return false;
  }
  update_best(record.table, result.best_row);
  // An unmerged multistart run whose recorded evaluations were not reproduced was restarted; the stage may then have
  // fewer evaluations than recorded.
  const bool restarted = !warnings_.empty();
  if (input.recorded && !restarted && record.table.size() < input.recorded->size())
    throw ReplayMismatch("stage " + std::to_string(index + 1) + " ended after " + std::to_string(record.table.size()) +
                         " of " + std::to_string(input.recorded->size()) + " recorded evaluations");
  record.best_row = result.best_row;
  if (result.front && !record.front) record.front = {.rows = result.front->rows, .reference = result.front->reference};
  if (record.table.shape().detail == Detail::derivatives) record.optimality = optimality_record(study_, record);
  stopped_.clear();  // a stop requested during the stage's last generation takes effect in the next stage
  record.finished = true;
  record.stop = words(result.reason);
  return true;
}

StageInput Run::stage_input(std::size_t index) {
  StageInput input{.problem = *study_.problem,
                   .evaluator = evaluator_,
                   .monitor = *this,
                   .seed = stage_seed(contents_.seed, index),
                   .starts = start_designs(study_, study_.stages[index], contents_),
                   .previous_front = previous_front(study_, contents_)};
  if (index < recorded_.size()) {
    input.recorded = &recorded_[index].table;
    input.recorded_starts = recorded_[index].starts;
    input.recorded_unmerged_runs = recorded_[index].ahead;
  }
  return input;
}

bool Run::generation(const Generation& g) {
  complete_rows_.reset();
  const std::int64_t made = evaluator_.made();
  const auto index = static_cast<std::size_t>(g.number);
  const StageRecord* const before = stage_ < recorded_.size() ? &recorded_[stage_] : nullptr;
  replaying_ = before && made == made_;
  made_ = made;
  const bool timed = replaying_ && index < before->generations.size();
  record_generation(g, study_.problem->space(),
                    timed ? before->generations.seconds[index] : earlier_seconds_ + seconds(), contents_.stages.back());
  ahead_ = g.ahead;
  complete_rows_ = g.table->size();
  // With several objectives, a solver's results are points of a front, whose best point is known only at the end of the
  // stage.
  if (g.front || study_.problem->objectives().size() < 2) update_best(*g.table, g.best_row);
  if (ranks::rank() == 0) {
    try {
      process_generation(g);
    } catch (...) {  // thrown again after the other ranks have been informed
      if (ranks::size() == 1 || g.alone) throw;
      failure_ = std::current_exception();
    }
  }
  if (ranks::size() > 1 && !g.alone) synchronise_ranks(g);
  return stopped_.empty() && !failed_;
}

bool Run::goes_on() {
  if (ranks::rank() != 0) return true;
  if (has_stop_request()) {
    stopped_ = signal_received() != 0 ? StopRequest::name(signal_received())
               : is_time_over()       ? "time limit"
                                      : "request";
  }
  return stopped_.empty();
}

bool Run::has_stop_request() const {
  return signal_received() != 0 || is_time_over() || (options_.stop && options_.stop());
}

bool Run::is_grace_period_over() {
  constexpr double kGracePeriod = 0.1;  // time [s] in which most generations and final steps end without being aborted
  if (!has_stop_request()) return false;
  const double now = seconds();
  double first = std::numeric_limits<double>::infinity();
  if (stop_requested_at_.compare_exchange_strong(first, now)) first = now;
  return now >= first + kGracePeriod;
}

void Run::warn(const std::string& sentence) {
  const std::string note = "stage " + std::to_string(stage_ + 1) + ": " + sentence;
  contents_.notes.push_back(note);
  warnings_.push_back(note);
}

void Run::update_best(const EvaluationTable& table, std::int64_t row) {
  const auto& objectives = study_.problem->objectives();
  if (row < 0 || objectives.empty()) return;
  const auto stage = static_cast<std::int64_t>(stage_);
  if (contents_.best.row >= 0 && contents_.best.stage != stage) {
    // With one objective, a design that ranks equal to the best design of an earlier stage does not replace it, so that
    // a stage without improvement does not change the best design.
    const RankKey before =
        ranked(objectives, contents_.best_stage().table, static_cast<std::size_t>(contents_.best.row));
    const RankKey candidate = ranked(objectives, table, static_cast<std::size_t>(row));
    // With several objectives the best design of a stage is its compromise solution, and the latest stage wins unless
    // its design has a worse status.
    if (objectives.size() > 1 ? candidate.status > before.status : !better(candidate, before)) return;
  }
  contents_.best = {stage, row};
}

void Run::process_generation(const Generation& g) {
  const ProgressReport report = progress_report(g);
  progress_.generation(report);
  if (options_.observer && !replaying_) options_.observer(contents_, report);
  if (goes_on() && !replaying_ && clock_.due()) clock_.checkpoint([&] { write(StudyState::running); });
}

void Run::synchronise_ranks(const Generation& g) {
  constexpr char kDecision = 'd', kFailed = '!';
  const std::uint64_t own = hash_of_rows(*g.table, g.first_row, g.table->size());
  std::string message(1, kDecision);
  message.append(reinterpret_cast<const char*>(&own), sizeof own) += failure_ ? std::string(1, kFailed) : stopped_;
  ranks::broadcast(message);
  std::uint64_t hash = 0;
  if (message.size() > sizeof hash) std::memcpy(&hash, message.data() + 1, sizeof hash);
  if (message.front() != kDecision || hash != own)
    ranks::abort_all_ranks("evaluations in generation " + std::to_string(g.number) + " of stage " +
                           std::to_string(stage_ + 1) + " differ from those on rank 0 (" + ranks::host(0) +
                           "); every host must run the same program with the same libraries");
  stopped_ = message.substr(1 + sizeof hash);
  failed_ = stopped_.starts_with(kFailed);
}

ProgressReport Run::progress_report(const Generation& g) {
  const StageRecord& stage = contents_.stages.back();
  ProgressReport r{.stage = stage_,
                   .stages = study_.stages.size(),
                   .optimiser = stage.optimiser,
                   .generation = g.number,
                   .evaluations = static_cast<std::int64_t>(g.table->size()),
                   .evaluation_limit = limit_,
                   .seconds = seconds()};
  if (!remaining_) remaining_.emplace(study_, options_.cost, threads_);
  r.left =
      remaining_->update(stage_, std::max<std::int64_t>(g.left.value_or(limit_ - r.evaluations), 0), made_, r.seconds);
  r.evaluations_per_second = r.seconds > 0 ? static_cast<double>(made_) / r.seconds : 0;
  r.feasible_share = stage.generations.feasible_share.back();
  if (!study_.problem->objectives().empty() && g.best_row >= 0) {
    const auto row = static_cast<std::size_t>(g.best_row);
    r.objective = study_.problem->objectives()[0].name;
    r.has_best = g.table->status[row] == Status::feasible;
    if (r.has_best)
      r.best = g.table->objective_row(row)[0];
    else
      r.violation = violation(g.table->margin_row(row));
  }
  if (g.front && r.has_best) {
    r.front = g.front->rows.size();
    r.hypervolume = g.front->hypervolume;
  }
  return r;
}

}  // namespace pkm
