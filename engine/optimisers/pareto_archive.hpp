// Archive of the non-dominated designs of a stage, and its quality indicators (hypervolume, IGD+).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/optimisers/dominance.hpp"

namespace pkm {

struct ParetoArchivePlan {
  std::size_t max_size = 0;              ///< maximum number of designs; 0: unlimited
  NamedNumbers reference = {};           ///< reference point of the hypervolume, by objective; empty: automatic
  std::size_t min_feasible_designs = 2;  ///< feasible designs required to set an automatic reference point
  std::vector<NamedNumbers> reference_front = {};  ///< points of a known front, by objective, for IGD+
};

/// The feasible non-dominated designs of a stage, with their indicators.
///
/// An automatic reference point is set at the end of the first generation by which at least `min_feasible_designs`
/// designs are feasible and every objective has a non-zero range among them: their worst value of each objective plus a
/// tenth of its range. It does not change afterwards. More than three objectives have neither reference point nor
/// hypervolume.
class ParetoArchive {
 public:
  ParetoArchive(const ParetoArchivePlan& plan, const Problem& problem, const EvaluationTable& table);

  /// Adds evaluated rows of the table. New rows must be in ascending order; rows added before are ignored.
  /// @return true if the front changed
  bool add(std::span<const std::int64_t> rows);
  const Front& front() const { return front_; }
  void set_spread(double spread) { front_.spread = spread; }
  /// Row of the Chebyshev (min-max) compromise solution; -1 while no design is feasible.
  std::int64_t compromise_row() const { return compromise_; }

 private:
  bool fix_reference_point(const Scores& feasible);
  double sign(std::size_t k) const { return problem_.objectives()[k].direction == Direction::maximise ? -1 : 1; }

  const Problem& problem_;
  const EvaluationTable& table_;
  NonDominatedSet archive_;
  std::size_t min_feasible_designs_;
  std::int64_t next_row_ = 0;                     // all rows before this one have been added
  Scores sample_;                                 // feasible designs until the reference point is fixed
  std::vector<double> reference_scores_;          // the reference point as minimised scores; empty: not yet set
  std::vector<double> reference_front_, ranges_;  // scores of the reference front, row by row, and their ranges
  Front front_;
  std::int64_t compromise_ = -1;
};

}  // namespace pkm
