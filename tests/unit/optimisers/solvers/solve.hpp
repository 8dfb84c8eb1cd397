// Helper functions for tests of solver stages.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {

using Changes = std::vector<std::pair<std::string, OptionValue>>;

inline double best_value(const Outcome& outcome) {
  return outcome.table.objectives[static_cast<std::size_t>(outcome.result.best_row)];
}

inline Outcome solve(const std::string& optimiser, const Problem& problem, const Changes& changes,
                     const std::vector<std::vector<double>>& starts, std::uint64_t seed = 1) {
  return run(*make(entry(optimiser), problem, changes), problem, seed, 1 << 30, nullptr, starts);
}

/// A start design of the welded beam.
inline const std::vector<double> kBeam = {0.5, 3, 9, 0.5};

}  // namespace pkm::test
