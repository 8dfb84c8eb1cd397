// Archive of the non-dominated designs of a stage, and its quality indicators (hypervolume, IGD+).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/optimisers/dominance.hpp"

namespace pkm {

struct ParetoArchivePlan {
  std::size_t max_size = 0;  ///< maximum number of designs; 0: unlimited
  /// The value of each objective at the reference point of the hypervolume, by name; empty: chosen automatically.
  NamedNumbers reference = {};
  /// Number of feasible designs required before an automatic reference point is chosen.
  std::size_t min_feasible_designs = 2;
  /// Points of a known Pareto front, each with the values of all objectives by name, for the indicator IGD+.
  std::vector<NamedNumbers> reference_front = {};
};

/// The feasible non-dominated designs of a stage, with their indicators.
///
/// An automatic reference point is set at the end of the first generation by which at least `min_feasible_designs`
/// designs are feasible and every objective has a non-zero range among them. In each objective it is the worst value of
/// these designs plus a tenth of the range of their values. It does not change afterwards. More than three objectives
/// have neither reference point nor hypervolume.
class ParetoArchive {
 public:
  ParetoArchive(const ParetoArchivePlan& plan, const Problem& problem, const EvaluationTable& table);

  /// Adds evaluated rows of the evaluation table. New rows must be in ascending order; rows added before are ignored.
  /// @return true if the front changed
  bool add(std::span<const std::int64_t> rows);
  const Front& front() const { return front_; }
  void set_spread(double spread) { front_.spread = spread; }
  /// Row number of the Chebyshev (min-max) compromise solution in the evaluation table; -1 while no design is feasible.
  std::int64_t compromise_row() const { return compromise_; }

 private:
  bool fix_reference_point(const Scores& feasible);
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }

  const Problem& problem_;
  const EvaluationTable& table_;
  NonDominatedSet archive_;
  std::size_t min_feasible_designs_;
  std::int64_t next_row_ = 0;             // all rows of the table before this one have been added
  Scores sample_;                         // scores of the feasible designs, collected until the reference point is set
  std::vector<double> reference_scores_;  // scores of the reference point (all minimised); empty: not yet set
  // Scores of the points of the known front, one point after another, and the range of each score over these points (1
  // if the range is 0), by which IGD+ divides.
  std::vector<double> reference_front_, ranges_;
  Front front_;
  std::int64_t compromise_ = -1;
};

}  // namespace pkm
