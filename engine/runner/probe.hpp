// Probe of a study before it is run: evaluates a small Sobol sample of the design space to detect problems without
// feasible designs.
#pragma once

#include <optional>

#include "engine/config/study.hpp"
#include "engine/problem/diagnosis.hpp"

namespace pkm {

struct Probe {
  static constexpr double kTimeLimit = 10;  ///< time limit for all designs together [s]

  EvaluationTable table;  ///< the sample designs with their evaluations; empty if one evaluation is too expensive
  std::optional<Diagnosis> diagnosis;  ///< set if no design is feasible, or if no objective value is meaningful
  bool is_cut_off = false;             ///< true if the time limit ended the probe before all designs were evaluated

  std::size_t feasible() const;
};

/// Number of sample designs: 4 to 64, depending on the estimated cost of an evaluation (number of cells and samples of
/// the workspace analyses); 0 if one evaluation is too expensive. The cost is estimated without measuring time, so that
/// the result is the same on all machines.
std::size_t probe_size(const DesignProblem& problem);

/// Evaluates a small number, probe_size(), of scrambled Sobol points of the design space, chosen by the study's seed,
/// until the time limit.
Probe probe(const Study& study);

/// Text such as "23 of 64 designs spread over the bounds are feasible".
std::string describe_probe(const Probe& probe);

}  // namespace pkm
