// How a stage's trade-off is found: design after design, and what it is worth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/optimisers/dominance.hpp"

namespace pkm {

struct FrontPlan {
  std::size_t limit = 0;                 ///< most designs; 0: no limit
  NamedNumbers reference = {};           ///< of the hypervolume, by objective; empty: see FrontKeeper
  std::size_t settled = 2;               ///< feasible designs that must be known before a reference is taken from them
  std::vector<NamedNumbers> front = {};  ///< reference front, points by objective
};

/// Keeps a stage's feasible non-dominated designs and their indicators.
///
/// A reference point that the plan does not give is fixed after the first generation by whose end enough feasible
/// designs are known, with a range in each objective: the worst of each among them, and a tenth of their range beyond.
class FrontKeeper {
 public:
  FrontKeeper(const FrontPlan& plan, const Problem& problem, const EvaluationTable& table);

  /// Takes evaluated rows, rising but for rows that were taken before; returns whether the front changed.
  bool add(std::span<const std::int64_t> rows);
  const Front& front() const { return front_; }
  void set_spread(double spread) { front_.spread = spread; }
  /// Row of the compromise; -1 while nothing is feasible.
  std::int64_t compromise_row() const { return compromise_; }

 private:
  bool fix_reference(const Scores& feasible);
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }

  const Problem& problem_;
  const EvaluationTable& table_;
  Archive archive_;
  std::size_t settled_;
  std::int64_t next_row_ = 0;               // rows before it were taken
  Scores seen_;                             // feasible designs until the reference is fixed
  std::vector<double> corner_;              // the reference as scores
  std::vector<double> target_, per_range_;  // scores of the reference front
  Front front_;
  std::int64_t compromise_ = -1;
};

}  // namespace pkm
