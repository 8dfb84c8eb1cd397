// Evaluations of a run, with the times that its parallel efficiency is made of.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "engine/problem/evaluator.hpp"

namespace pkm {

class TimedEvaluator final : public Evaluator {
 public:
  /// @param threads  as for ParallelEvaluator
  explicit TimedEvaluator(int threads) : inner_(threads) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;

  int threads() const { return inner_.threads(); }
  std::int64_t made() const { return made_; }  ///< evaluations
  /// Time of the evaluations over that of so many threads while anything was being evaluated.
  double efficiency(int threads) const { return wall_ > 0 ? busy_ / (wall_ * threads) : 0; }
  /// Gives back what it has reserved for evaluations.
  void forget() { inner_ = ParallelEvaluator(inner_.threads()); }

 private:
  /// Rows [first, table.size()), which a call has evaluated.
  void add(const EvaluationTable& table, std::size_t first);
  /// Of the calls at work.
  void count(int more);

  ParallelEvaluator inner_;
  std::mutex mutex_;
  int calls_ = 0;
  double begin_ = 0;
  double wall_ = 0, busy_ = 0;  ///< s
  std::atomic<std::int64_t> made_ = 0;
};

}  // namespace pkm
