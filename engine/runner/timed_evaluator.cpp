#include "engine/runner/timed_evaluator.hpp"

#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/storage/checkpoint_clock.hpp"

namespace pkm {

void TimedEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  change_active_calls(1);
  try {
    inner_.evaluate(problem, table, first);
  } catch (const Stopped&) {
    end_call(table, first);
    throw;
  }
  end_call(table, first);
}

void TimedEvaluator::end_call(const EvaluationTable& table, std::size_t first) {
  change_active_calls(-1);
  const std::lock_guard guard(mutex_);
  made_ += static_cast<std::int64_t>(table.size() - first);
  // If there is a single row, every MPI rank evaluates it, instead of sharing rows.
  const int ranks = table.size() - first == 1 ? ranks::size() : 1;
  for (std::size_t row = first; row < table.size(); ++row) busy_ += ranks * static_cast<double>(table.seconds[row]);
}

void TimedEvaluator::change_active_calls(int change) {
  const std::lock_guard guard(mutex_);
  if (active_calls_ == 0) begin_ = steady_seconds();
  active_calls_ += change;
  if (active_calls_ == 0) wall_ += steady_seconds() - begin_;
}

}  // namespace pkm
