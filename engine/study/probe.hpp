// A few designs, spread over the bounds of a study, evaluated before it is run.
#pragma once

#include <optional>

#include "engine/problem/verdict.hpp"
#include "engine/setup/study.hpp"

namespace pkm {

struct Probe {
  static constexpr double kLongest = 10;  ///< s, of all designs

  EvaluationTable table;           ///< the designs; none where one would cost too much
  std::optional<Verdict> verdict;  ///< where none is feasible, or none has an objective that says something

  bool is_cut_off = false;  ///< there would be more, but they take too long

  std::size_t feasible() const;
};

/// How many designs are worth trying: 64, fewer where surveys are costly by the number of their cells and samples, 0
/// where they are very costly. No clock is asked, so it is the same everywhere.
std::size_t probe_size(const DesignProblem& problem);

/// Evaluates as many Sobol points of the design space, by the study's seed, but for those that take too long.
Probe probe(const Study& study);

/// "23 of 64 designs spread over the bounds are feasible"
std::string words(const Probe& probe);

}  // namespace pkm
