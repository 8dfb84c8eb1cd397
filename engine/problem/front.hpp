// The trade-off that a stage has found: who is on it, how far it reaches, which points of it stand out.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/problem/problem.hpp"

namespace pkm {

/// A trade-off: feasible designs of a stage that no other one dominates (as many as an archive's limit allows); of a
/// solver stage the ends of its starts.
struct Front {
  std::vector<std::int64_t> rows;  ///< of the stage's table; the best by the first objective first
  /// Corner of the hypervolume, in the objectives' units, and what it encloses with the front: only what is better than
  /// the corner in every objective counts. Empty and NaN while there is none.
  std::vector<double> reference = {};
  double hypervolume = std::numeric_limits<double>::quiet_NaN();
  double spread = std::numeric_limits<double>::quiet_NaN();    ///< of the population's part of it (see diversity.hpp)
  double igd_plus = std::numeric_limits<double>::quiet_NaN();  ///< to the reference front; NaN where none is given
};

/// Scores of some designs, row by row.
struct Scores {
  std::size_t objectives = 0;
  std::vector<double> values = {};

  std::size_t size() const { return objectives ? values.size() / objectives : 0; }
  const double* operator[](std::size_t i) const { return &values[i * objectives]; }
  void add(std::span<const double> row) { values.insert(values.end(), row.begin(), row.end()); }
  void clear() { values.clear(); }
};

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

/// Scores from 0 to 1 over the front; 0 where all are alike.
Scores normalised(const Scores& front);

/// The best design of each score, the first of several. The front must not be empty.
std::vector<std::size_t> ends_of(const Scores& front);

/// The design nearest to the ideal: its worst score, each from 0 for the front's best to 1 for its worst, is the least
/// of all; of several the cheapest, then the first. The front must not be empty.
std::size_t compromise(const Scores& front);

/// Knees: designs cheaper than every other one within a fifth of the ranges, and than the front's ends by a hundredth
/// of them, cheapest first. To leave one in any direction costs more than it gains. Concave fronts have none.
std::vector<std::size_t> knees(const Scores& front);

/// `count` designs of a front that are spread over it: the compromise, the best of each score, then always the one
/// farthest from those chosen, in units of the ranges. In the order of the front.
std::vector<std::size_t> spread_choice(const Scores& front, std::size_t count);

}  // namespace pkm
