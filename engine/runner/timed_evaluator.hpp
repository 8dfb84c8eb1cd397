// Evaluator of a run: evaluates in parallel, counts evaluations, and measures the parallel efficiency.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "engine/problem/evaluator.hpp"

namespace pkm {

class TimedEvaluator final : public Evaluator {
 public:
  /// @param threads  number of threads; 0: OpenMP's default (see team_size())
  explicit TimedEvaluator(int threads) : inner_(threads) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;

  int threads() const { return inner_.threads(); }
  std::int64_t made() const { return made_; }  ///< number of evaluations made so far
  /// @return sum of the evaluation times / (threads * wall time with active calls of evaluate())
  double efficiency(int threads) const { return wall_ > 0 ? busy_ / (wall_ * threads) : 0; }
  /// Releases the scratch memory of the evaluations.
  void release_memory() { inner_ = ParallelEvaluator(inner_.threads()); }

 private:
  /// Called when evaluate() has evaluated rows [first, table.size()): adds their number and times to the totals.
  void end_call(const EvaluationTable& table, std::size_t first);
  /// Changes the number of active calls of evaluate(), and measures the wall time during which at least one is active.
  void change_active_calls(int change);

  ParallelEvaluator inner_;
  std::mutex mutex_;
  int active_calls_ = 0;
  double begin_ = 0;  ///< beginning of the current period with active calls of evaluate() [s]
  /// Wall time during which calls of evaluate() were active, and sum of the times of all evaluations [s].
  double wall_ = 0, busy_ = 0;
  std::atomic<std::int64_t> made_ = 0;
};

}  // namespace pkm
