// The trade-off that a stage has found: who is on it, how far it reaches, which points of it stand out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/optimisers/evolutionary/dominance.hpp"
#include "engine/optimisers/optimiser.hpp"

namespace pkm {

/// Appends a row's objectives, turned so that less is better.
void add_scores(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table, std::size_t row,
                Scores& scores);
Scores scores_of(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table,
                 std::span<const std::int64_t> rows);

/// Least and greatest of each score.
struct Ranges {
  std::vector<double> least, greatest;
  double range(std::size_t k) const { return greatest[k] - least[k]; }
};
Ranges ranges_of(const Scores& front);

/// The best design of each score, the first of several. The front must not be empty.
std::vector<std::size_t> ends_of(const Scores& front);

/// The design nearest to the ideal: its worst score, each from 0 for the front's best to 1 for its worst, is the least
/// of all; of several the cheapest, then the first. The front must not be empty.
std::size_t compromise(const Scores& front);

/// Knees: designs that are cheaper than every other one within a fifth of the ranges and cheaper than the front's
/// ends, cheapest first. To leave one in any direction costs more than it gains. Concave fronts have none.
std::vector<std::size_t> knees(const Scores& front);

/// `count` designs of a front that are spread over it: the compromise, the best of each score, then always the one
/// farthest from those chosen, in units of the ranges. In the order of the front.
std::vector<std::size_t> spread_choice(const Scores& front, std::size_t count);

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
