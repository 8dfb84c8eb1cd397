// Record and replay: an evaluator that returns the recorded evaluations of an interrupted run before it computes new
// ones.
//
// An optimiser is a deterministic function of the evaluations it receives. Running it again on the recorded results
// therefore restores exactly the state in which the earlier run stopped. If only the first rows of a batch are recorded
// (because a limit stopped the run within the batch), the remaining rows are computed.
#pragma once

#include <stdexcept>

#include "engine/problem/evaluator.hpp"

namespace pkm {

/// Exception: the optimiser requests another design than the recorded one, so that the record belongs to another study
/// or program version.
class ReplayMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ReplayEvaluator final : public Evaluator {
 public:
  /// @param inner   computes the rows that are not recorded; must outlive this object
  /// @param record  the recorded evaluation table of the stage; must outlive this object
  ReplayEvaluator(Evaluator& inner, const EvaluationTable& record) : inner_(inner), record_(record) {}

  /// Copies each recorded row r, including its time, to row r of `table`, and evaluates the rows that are not recorded.
  /// Throws ReplayMismatch if the shapes differ or a design differs in any bit (the message gives the row).
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;

 private:
  Evaluator& inner_;
  const EvaluationTable& record_;
};

}  // namespace pkm
