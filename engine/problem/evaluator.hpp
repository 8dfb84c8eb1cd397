// Batch evaluation: an optimiser hands over a list of designs and gets a list of evaluations.
#pragma once

#include "engine/core/team.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Evaluates rows [first, table.size()), whose designs are set; how they are shared out does not show in the result.
  /// An exception in one design marks its row failed; std::bad_alloc, which says nothing of a design, passes through.
  virtual void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) = 0;
  /// Evaluators that serve a record: rows of the table from `row` on are rows [first, end) of the record, in order, and
  /// those after them new. Others have nothing to do.
  virtual void follow(std::size_t /*row*/, std::size_t /*first*/, std::size_t /*end*/) {}
};

/// By a team of threads: it shares out the designs, or, where they are few and take long, what surveys have to share
/// out within each. The team is the caller's; outside with_team() one is made for each call, which a run of many calls
/// is better without.
class ParallelEvaluator final : public Evaluator {
 public:
  /// @param threads  as for team_size(); within with_team(), 1 or those of the team
  explicit ParallelEvaluator(int threads = 0) : threads_(team_size(threads)), scratch_(1) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;
  int threads() const { return threads_; }

 private:
  int threads_;
  std::vector<Scratch> scratch_;  ///< of each worker
};

}  // namespace pkm
