// Parallel batch evaluation of designs, by a team of threads and by MPI ranks, with results that do not depend on how
// the work is distributed.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "engine/core/team.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

/// Evaluates one design on this thread. If this throws DesignError or gives values that contradict the status, the
/// design gets the status `failed`; other exceptions are rethrown.
void evaluate_design(const Problem& problem, std::span<const double> design, Scratch& scratch,
                     const EvaluationSlot& slot);

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Evaluates rows [first, table.size()), whose designs are set. The results do not depend on the distribution of the
  /// rows. A design whose evaluation throws DesignError gets the status `failed`; other exceptions are rethrown. After
  /// Stopped, the table ends before the first incomplete row.
  virtual void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) = 0;
};

/// Evaluates with a team of threads: in parallel over the designs, or, if there are few designs that take long, in
/// parallel within the workspace analysis of each. It uses the caller's team; outside with_team(), every call creates a
/// team, which is slow for many calls. The threads of one team may call it concurrently, each with its own table.
///
/// With several MPI ranks, all ranks pass the same designs and receive the same results, and each computes a part of
/// the rows. The rows are distributed statically by index, or dynamically: ranks claim chunks of decreasing size
/// (guided self-scheduling). The dynamic distribution is used if the static one leaves ranks idle, or if claims are
/// cheap compared with the evaluations. Batches that are cheaper than the messages (among them single designs) are
/// evaluated by every rank without communication.
class ParallelEvaluator final : public Evaluator {
 public:
  /// @param threads  number of threads; 0: OpenMP's default (see team_size()); within with_team(), 1 or the size of the
  ///   team
  explicit ParallelEvaluator(int threads = 0)
      : threads_(team_size(threads)), scratch_(static_cast<std::size_t>(threads_)) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;
  int threads() const { return threads_; }

 private:
  /// Timings of the latest batch that was distributed among MPI ranks. They are identical on every rank, so that all
  /// ranks choose the same distribution.
  struct BatchTimings {
    double seconds_per_design = 0;  ///< mean evaluation time in the latest batch shared by MPI ranks [s]; 0: none
    bool imbalanced = true;         ///< true: the next batch is distributed dynamically
    std::size_t local_batches = 0;  ///< batches since the latest shared one, which every rank evaluated itself
  };
  using Rows = std::pair<std::size_t, std::size_t>;  // first row, end row (excluded)

  /// Evaluates rows on this MPI rank, with one or several threads.
  /// @param design_seconds  expected time per design on one thread [s]; 0: unknown
  void evaluate_here(const Problem& problem, EvaluationTable& table, Rows rows, double design_seconds);
  void evaluate_with_ranks(const Problem& problem, EvaluationTable& table, std::size_t first, BatchTimings& timings);
  void compare_ranks(const EvaluationTable& table, std::size_t row);
  std::vector<Rows> claim_chunks(const Problem& problem, EvaluationTable& table, Rows rows);

  int threads_;
  std::vector<std::size_t> threads_of_ranks_;
  std::vector<Scratch> scratch_;         ///< scratch memory of each worker thread
  std::array<BatchTimings, 3> timings_;  ///< timings of the batches of each level of detail, indexed by Detail
};

}  // namespace pkm
