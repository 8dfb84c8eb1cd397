// Runs pagmo's optimisers on one of the two problems, with any evaluator of candidates.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pkm::peers {

/// Objective and constraints of a candidate design.
struct Candidate {
  double ratio = 0;             ///< V / V_mech, to be maximised [rad]
  std::vector<double> margins;  ///< constraint values, satisfied if >= 0
};

/// Optimisation problem and target for pagmo.
struct Task {
  std::vector<double> lower, upper;  ///< bounds of (a, b, l_u, l_d) [m]
  std::size_t constraints = 0;
  std::function<Candidate(const std::vector<double>& design)> evaluate;
  double target = 0;  ///< ratio from which a feasible design counts as found
};

/// Performs the action `generations N SEED` or `search SEEDS LIMIT`, as defined in peer.py, with one of pagmo's
/// optimisers. Prints JSON.
/// @throws std::invalid_argument for an unknown tool or action
void run_pagmo(const std::string& tool, const Task& task, std::span<char* const> action);

}  // namespace pkm::peers
