#include "engine/optimisers/solvers/joined_starts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/ranks.hpp"

namespace pkm {

JoinedStarts::JoinedStarts(const SolverPlan& plan, const StageInput& input, EvaluationTable& table)
    : input_(input),
      limit_(plan.limits.evaluations),
      table_(table),
      how_(plan.scalarisation),
      starts_(starts_of_stage(plan, input)) {
  const auto& objectives = input.problem.objectives();
  if (objectives.size() == 1) return;
  how_.extents = input.known_front.extents;
  FrontPlan front;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    if (objectives[k].name == plan.objective) how_.objective = k;
    if (!input.known_front.reference.empty()) front.reference[objectives[k].name] = input.known_front.reference[k];
  }
  front_.emplace(front, input.problem, table);
}

bool JoinedStarts::join() {
  while (!stopped_ && next_ < starts_.size()) {
    StartRun& start = starts_[next_];
    // A replay may leave the recorded path, and begin anew.
    if (!start.ended && start.table.size() <= start.recorded.size()) break;
    while (!stopped_ && joined_ < start.table.size()) stopped_ = !report(start.table, joined_++);
    if (stopped_ || !start.ended) break;
    end(start);
  }
  if (!stopped_ && !input_.monitor.goes_on()) stopped_ = true;
  return !stopped_;
}

bool JoinedStarts::report(const EvaluationTable& start, std::size_t source) {
  const std::size_t row = table_.append(start, source);
  if (source == 0) {
    goal_.emplace(how_, input_.problem, table_, row);
    best_of_start_ = {};
  }
  const Ranked candidate = goal_->rank(row);
  if (best_of_start_.row < 0 || candidate < best_of_start_) best_of_start_ = candidate;
  // Of several objectives the stage's best is on its front, which knows the ends of starts.
  if (best_.row < 0 || (how_.kind == Scalarisation::Kind::none && candidate < best_)) best_ = candidate;
  population_ = {best_of_start_.row};
  return input_.monitor.generation({.number = static_cast<std::int64_t>(row),
                                    .first_row = row,
                                    .table = &table_,
                                    .population = &population_,
                                    .best_row = best_.row,
                                    .starts = &finished_,
                                    .ahead = [this] { return ahead(); },
                                    .left = left(),
                                    .alone = true});
}

void JoinedStarts::end(StartRun& start) {
  StartOutcome outcome = start.outcome;
  outcome.first_row = static_cast<std::int64_t>(table_.size() - start.table.size());
  outcome.end_row += outcome.first_row;
  if (!start.warning.empty()) input_.monitor.warn(start.warning);
  if (front_) {  // the end becomes a point of the stage's front
    front_->add(std::array{outcome.end_row});
    if (front_->compromise_row() >= 0)
      best_ = ranked(input_.problem.objectives(), table_, static_cast<std::size_t>(front_->compromise_row()));
  }
  finished_.push_back(std::move(outcome));
  if (ranks::size() == 1) start.table = EvaluationTable();  // the stage's table has it; other ranks do not
  ++next_;
  joined_ = 0;
}

void JoinedStarts::know(StartAhead&& of) {
  StartRun& start = starts_.at(static_cast<std::size_t>(of.number));
  if (start.ended) return;
  start.ended = of.outcome.has_value();
  if (start.ended) start.outcome = std::move(*of.outcome);
  (start.ended ? start.table : start.recorded) = std::move(of.table);
}

StartAhead JoinedStarts::known_of(std::size_t k) const {
  const StartRun& start = starts_[k];
  StartAhead known{static_cast<std::int64_t>(k), start.known(), {}};
  if (start.ended) known.outcome = start.outcome;
  return known;
}

std::int64_t JoinedStarts::left() {
  if (table_.size() < counts_at_) return left_;
  counts_at_ = table_.size() + starts_.size() / 16;
  left_ = 0;
  for (std::size_t k = next_; k < starts_.size(); ++k)
    if (!starts_[k].ended) left_ += limit_ - static_cast<std::int64_t>(starts_[k].table.size());
  return left_;
}

std::vector<StartAhead> JoinedStarts::ahead() const {
  std::vector<StartAhead> known;
  for (std::size_t k = next_; k < starts_.size(); ++k) {
    const StartRun& start = starts_[k];
    if (k == next_ && !start.ended && start.known().size() == joined_) continue;
    if (start.known().size() > 0) known.push_back(known_of(k));
  }
  return known;
}

StopReason JoinedStarts::reason() const {
  for (const StopReason each : {StopReason::tolerance, StopReason::evaluations, StopReason::time, StopReason::failed})
    if (std::ranges::all_of(finished_, [&](const StartOutcome& o) { return o.stop == words(each); })) return each;
  return StopReason::starts;
}

StageResult JoinedStarts::result() const {
  if (stopped_) return {StopReason::interrupted, best_.row, finished_, ahead()};
  StageResult result{reason(), best_.row, finished_};
  if (front_) result.front = front_->front();
  return result;
}

}  // namespace pkm
