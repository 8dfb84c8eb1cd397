// pagmo's optimisers on one of the two problems, whoever computes its candidates.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pkm::peers {

/// Value of a candidate.
struct Candidate {
  double ratio = 0;             ///< V / V_mech, to be maximised [rad]
  std::vector<double> margins;  ///< of the task's constraints, which hold when >= 0
};

/// What pagmo is given.
struct Task {
  std::vector<double> lower, upper;  ///< bounds of (a, b, l_u, l_d) [m]
  std::size_t constraints = 0;
  std::function<Candidate(const std::vector<double>& design)> evaluate;
  double target = 0;  ///< the ratio from which a feasible design counts as found
};

/// What peer.py calls `generations N SEED` and `search SEEDS LIMIT`, by one of pagmo's optimisers. Prints JSON.
/// @throws std::invalid_argument for another tool or action
void run_pagmo(const std::string& tool, const Task& task, std::span<char* const> action);

}  // namespace pkm::peers
