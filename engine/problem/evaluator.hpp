// Batch evaluation: an optimiser hands over a list of designs and gets a list of evaluations.
#pragma once

#include "engine/core/team.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Evaluates rows [first, table.size()) of `table`, whose designs are set. The result does not depend on how the rows
  /// are shared out. An exception in one design marks that row failed and leaves the others intact.
  virtual void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) = 0;
};

/// By a team of threads: it shares out the designs, or, where they are few and take long, what surveys have to share
/// out within each. The team is the caller's; outside with_team() one is made for each call, which a run of many calls
/// is better without. Threads of one team may call it at once, each with a table of its own.
class ParallelEvaluator final : public Evaluator {
 public:
  /// @param threads  as for team_size(); within with_team(), 1 or those of the team
  explicit ParallelEvaluator(int threads = 0)
      : threads_(team_size(threads)), scratch_(static_cast<std::size_t>(threads_)) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;
  int threads() const { return threads_; }

 private:
  int threads_;
  std::vector<Scratch> scratch_;  ///< of each worker
};

}  // namespace pkm
