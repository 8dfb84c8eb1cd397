#include "engine/study/timed_evaluator.hpp"

#include "engine/core/ranks.hpp"
#include "engine/core/stop.hpp"
#include "engine/storage/checkpoint_clock.hpp"

namespace pkm {

void TimedEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  count(1);
  try {
    inner_.evaluate(problem, table, first);
  } catch (const Stopped&) {
    add(table, first);
    throw;
  }
  add(table, first);
}

void TimedEvaluator::add(const EvaluationTable& table, std::size_t first) {
  count(-1);
  const std::lock_guard guard(mutex_);
  made_ += static_cast<std::int64_t>(table.size() - first);
  // A single row is each rank's own work.
  const int ranks = table.size() - first == 1 ? ranks::size() : 1;
  for (std::size_t row = first; row < table.size(); ++row) busy_ += ranks * static_cast<double>(table.seconds[row]);
}

void TimedEvaluator::count(int more) {
  const std::lock_guard guard(mutex_);
  if (calls_ == 0) begin_ = steady_seconds();
  calls_ += more;
  if (calls_ == 0) wall_ += steady_seconds() - begin_;
}

}  // namespace pkm
