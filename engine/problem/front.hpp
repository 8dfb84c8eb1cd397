// The Pareto front of a stage: its designs and quality indicators, and the selection of designs from it (compromise,
// knees, representative subset).
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/problem/problem.hpp"

namespace pkm {

/// A Pareto front: the feasible non-dominated designs of a stage, up to the size limit of the archive. In a solver
/// stage, the designs are results of its multistart runs.
struct Front {
  std::vector<std::int64_t> rows;  ///< rows of the evaluation table, sorted by the first objective, best first
  /// Reference point of the hypervolume, in the objectives' units, and the hypervolume. Only designs that are better
  /// than the reference point in every objective contribute. Empty and NaN if there is no reference point yet.
  std::vector<double> reference = {};
  double hypervolume = std::numeric_limits<double>::quiet_NaN();
  /// Spacing indicator (crowding.hpp) of those designs of the front that are in the population; NaN: unknown.
  double spread = std::numeric_limits<double>::quiet_NaN();
  double igd_plus = std::numeric_limits<double>::quiet_NaN();  ///< distance IGD+ to the known reference front; NaN if
                                                               ///< there is no reference front
};

/// Objective vectors of several designs, row by row, with signs such that smaller scores are better.
struct Scores {
  std::size_t objectives = 0;
  std::vector<double> values = {};

  std::size_t size() const { return objectives ? values.size() / objectives : 0; }
  const double* operator[](std::size_t i) const { return &values[i * objectives]; }
  void add(std::span<const double> row) { values.insert(values.end(), row.begin(), row.end()); }
  void clear() { values.clear(); }
};

/// Appends the objectives of a row of an evaluation table as scores: maximised objectives change their sign.
void add_scores(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table, std::size_t row,
                Scores& scores);
Scores scores_of(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table,
                 std::span<const std::int64_t> rows);

/// Minimum and maximum of each score over a front (its ideal and nadir points).
struct Ranges {
  std::vector<double> minimum, maximum;
  double range(std::size_t k) const { return maximum[k] - minimum[k]; }
};
Ranges ranges_of(const Scores& front);

/// Scores scaled to [0, 1] over the front; a score that is constant over the front becomes 0.
Scores normalised(const Scores& front);

/// Extreme points: for each score, the first design with its minimum. The front must not be empty.
std::vector<std::size_t> ends_of(const Scores& front);

/// Chebyshev compromise solution: the design that minimises the maximum of its normalised scores. Ties are broken by
/// the lowest sum of normalised scores, then by the lowest index. The front must not be empty.
std::size_t compromise(const Scores& front);

/// Knees of the front, by increasing cost; the cost of a design is the sum of its normalised scores. A knee has the
/// lowest cost within a distance of 0.2 (maximum norm of the normalised scores), and at least 0.01 less than every
/// extreme point. Moving away from a knee, the scores that get worse lose more than the others gain. A concave front
/// has no knees, and neither has a front of fewer than 10 designs: its designs have too few neighbours.
std::vector<std::size_t> knees(const Scores& front);

/// Representative subset of `count` designs by farthest-point sampling: starts with the compromise and the extreme
/// points, then repeatedly adds the design farthest from those chosen (maximum norm of the normalised scores). Returns
/// indices in the order of the front; fewer than `count` if the remaining designs coincide with chosen ones.
std::vector<std::size_t> select_representatives(const Scores& front, std::size_t count);

}  // namespace pkm
