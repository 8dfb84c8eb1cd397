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
  ReplayEvaluator(Evaluator& inner, const EvaluationTable& record)
      : inner_(inner), record_(record), end_(record.size()) {}

  /// Row r of `table` takes row r of the record (or the one that `follow` says), its seconds included. Throws
  /// ReplayMismatch, naming the row, when the designs differ in any bit or the shapes differ.
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override;
  void follow(std::size_t row, std::size_t first, std::size_t end) override {
    row_ = row;
    first_ = first;
    end_ = end;
  }

 private:
  Evaluator& inner_;
  const EvaluationTable& record_;
  std::size_t row_ = 0, first_ = 0, end_;  ///< row_ of the table is first_ of the record, and so on up to end_
};

}  // namespace pkm
