// Batch evaluation: an optimiser hands over a list of designs and gets a list of evaluations.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "engine/core/team.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Evaluates rows [first, table.size()), whose designs are set; how they are shared out does not show in the result.
  /// An exception in one design marks its row failed; std::bad_alloc passes through, Stopped too: complete rows stay.
  virtual void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) = 0;
};

/// By a team of threads: it shares out the designs, or, where they are few and take long, what surveys have to share
/// out within each. The team is the caller's; outside with_team() one is made for each call, which a run of many calls
/// is better without. Threads of one team may call it at once, each with a table of its own.
///
/// Where there are several ranks, all of them hand over the same designs and get the same results. Each computes a
/// share of the rows: by index, or, where that would leave ranks waiting or claims cost next to nothing, chunks that
/// are claimed in turn and get smaller towards the end. One design, or some that take less than the messages would,
/// each rank evaluates alone, without a message.
class ParallelEvaluator final : public Evaluator {
 public:
  /// @param threads  as for team_size(); within with_team(), 1 or those of the team
  explicit ParallelEvaluator(int threads = 0)
      : threads_(team_size(threads)), scratch_(static_cast<std::size_t>(threads_)) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;
  int threads() const { return threads_; }

 private:
  /// What batches that were shared among ranks have shown: the same on every rank, so that all decide alike.
  struct Experience {
    double each = 0;        ///< s, of a design; 0: there was none
    bool uneven = true;     ///< shares by index would have left ranks waiting
    std::size_t alone = 0;  ///< batches since then that each rank evaluated alone
  };
  using Rows = std::pair<std::size_t, std::size_t>;  // first, end

  void evaluate_here(const Problem& problem, EvaluationTable& table, Rows rows, double each);
  void evaluate_with_ranks(const Problem& problem, EvaluationTable& table, std::size_t first, Experience& known);
  void compare_ranks(const EvaluationTable& table, std::size_t row);
  std::vector<Rows> claim_chunks(const Problem& problem, EvaluationTable& table, Rows rows);

  int threads_;
  std::vector<std::size_t> threads_of_ranks_;
  std::vector<Scratch> scratch_;          ///< of each worker
  std::array<Experience, 3> experience_;  ///< with each Detail
};

}  // namespace pkm
