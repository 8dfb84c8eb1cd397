// Serves recorded evaluations before it computes new ones: how a resumed run repeats its past.
//
// An optimiser is a deterministic function of what it is told, so running it anew on the recorded results brings it to
// exactly the state in which the earlier run stopped. A batch of which only the first rows are recorded (a limit cut
// it short) is completed.
#pragma once

#include <stdexcept>

#include "engine/problem/evaluator.hpp"

namespace pkm {

/// The optimiser asked for another design than the record holds: the record is of another study or another program.
class ReplayMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ReplayEvaluator final : public Evaluator {
 public:
  /// Both must outlive this. `record` is the stage's table as stored; `inner` computes what it does not hold.
  ReplayEvaluator(Evaluator& inner, const EvaluationTable& record) : inner_(inner), record_(record) {}

  /// Row r of `table` takes row r of the record, its seconds included. Throws ReplayMismatch, naming the row, when the
  /// designs differ in any bit or the shapes differ.
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;

 private:
  Evaluator& inner_;
  const EvaluationTable& record_;
};

}  // namespace pkm
